// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "identify/six_axis_fit.hpp"
#include "kelpie/motion/attitude.hpp"
#include "kelpie/motion/frame.hpp"
#include "log/dataset.hpp"
#include "simulator/parameters.hpp"
#include "simulator/simulation.hpp"
#include "study/identification.hpp"
#include "study/split.hpp"

namespace kelpie::study {

/// Roles of a log's columns in identification on six axes: places among inputs and targets.
struct SixAxisColumns {
  std::array<std::size_t, kSixAxes> velocities{};
  std::array<std::size_t, kSixAxes> targets{};  ///< accelerations of the velocities
  Attitude attitude{};
  std::vector<std::size_t> thrusters{};  ///< inputs, in the order of the vehicle file
  std::optional<std::size_t> volts{};    ///< input: supply of the thrusters
};

/// The sign of a body axis' velocities and accelerations in FRD, over those in `frame`, FLU or FRD.
constexpr double sign_in_frd(Frame frame, std::size_t axis) {
  return frame == Frame::flu && axis != 0 && axis != 3 ? -1.0 : 1.0;
}

/// The columns, if the log has six velocities with targets, an attitude, and a command for each
/// thruster of the vehicle, by name; otherwise none, and `why` says what is missing. Throws
/// InputError (--volts) on a name that is no input.
std::optional<SixAxisColumns> six_axis_columns(const log::Dataset& data, const std::string& states,
                                               const simulator::VehicleParameters& vehicle,
                                               const std::string& volts, std::string& why);

/// Ascending rows for fit_six_axes(), turned to FRD. Commands by the vehicle's unit: 0 at rest, ±1
/// in full. `neutral`: pulse at rest in the log, 1500, or 0 where it has been subtracted. Throws
/// InputError (--volts) on a supply far from the vehicle's, as in mV.
SixAxisRows six_axis_rows(const log::Dataset& data, const std::vector<std::size_t>& rows,
                          const SixAxisColumns& columns,
                          const simulator::VehicleParameters& vehicle, Frame frame, double neutral);

/// Rows of a simulated log of six axes.
SixAxisRows six_axis_rows(const std::vector<simulator::SixAxisRow>& log,
                          const simulator::VehicleParameters& vehicle);

/// The direction of gravity in the body, FRD (Fossen 2011, eq. 4.6), at a row of inputs with an
/// attitude in the axes `frame`; straight down without an attitude.
std::array<double, 3> down_of(const Attitude& attitude, std::span<const double> inputs,
                              Frame frame);

/// A logged command of a thruster as a share of full, by the unit of the vehicle file. `neutral`:
/// as in six_axis_rows().
double command_share(const simulator::VehicleParameters& vehicle, std::size_t thruster,
                     double command, double neutral);

/// The command for a share of full: inverse of command_share().
double command_for_share(const simulator::VehicleParameters& vehicle, std::size_t thruster,
                         double share, double neutral);

/// The parameters of a vehicle file in the order of SixAxisPlace: what should be identified.
std::vector<double> six_axis_truth(const simulator::VehicleParameters& vehicle);

/// Identifies on the training rows of the configuration `only` (default: the first), and scores on
/// its held-out rows. `known`: the scale. Throws what fit_six_axes() throws, naming the log.
Identification identify_six_axes(const log::Dataset& data, const Split& split,
                                 const SixAxisColumns& columns,
                                 const simulator::VehicleParameters& vehicle, Frame frame,
                                 double neutral, const KnownThrust& known, std::optional<int> only,
                                 const SixAxisSettings& options);

}  // namespace kelpie::study
