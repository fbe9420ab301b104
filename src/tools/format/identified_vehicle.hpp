// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "kelpie/motion/frame.hpp"
#include "log/dataset.hpp"
#include "simulator/parameters.hpp"
#include "study/certificate.hpp"
#include "study/identification.hpp"
#include "study/six_axes.hpp"

namespace kelpie::format {

/// A fixed thruster with the force K± n|n| along `direction`.
struct IdentifiedThruster {
  std::string name{};
  double forward = 0.0;  ///< N/(rev/s)², or N at full command
  double reverse = 0.0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();
  double greatest = 0.0;      ///< in the log, absolute: rev/s, or share of the full command
  bool reverse_told = false;  ///< else `reverse` equals `forward`
  double lag_s = 0.0;         ///< time constant; 0: none was found

  double thrust(double speed_rps) const;             ///< N
  simulator::Vector6 force(double speed_rps) const;  ///< about the origin
};

/// An identified vehicle in six degrees of freedom, for simulators: SI, frame FRD, about the origin
/// of the measured velocities. Quantities outside the plane come from a base vehicle or are
/// assumed.
struct IdentifiedVehicle {
  simulator::VehicleParameters body{};  ///< thrusters only where `has_slots`
  std::vector<IdentifiedThruster> thrusters{};
  std::array<bool, 6> identified{};                                ///< axes that the log shows
  simulator::Vector6 constant_force = simulator::Vector6::Zero();  ///< in the log, FRD
  std::string rest{};        ///< source of heave, roll, pitch and the split of masses
  std::string speed_unit{};  ///< "rev/s", and whether the log said so
  bool speeds = true;        ///< thrusters by rev/s; else by shares of the full command
  bool has_slots = false;  ///< all thrusters are in `body`, or two thrusters along surge, one along
                           ///< sway: body.thrusters are set
};

/// Requires an identification with a scale. `base`: the file of --vehicle, or none. Throws
/// InputError on a thruster's unit other than a speed, and on a mass above the identified inertia.
IdentifiedVehicle identified_vehicle(const study::Identification& found, Frame frame,
                                     const std::optional<simulator::VehicleParameters>& base,
                                     const std::string& base_file);

/// Requires an identification on six axes with a scale. `base`: the vehicle file with the
/// thrusters; what the log doesn't tell is taken from it. Throws InputError on a mass above an
/// inertia.
IdentifiedVehicle identified_on_six_axes(const study::Identification& found,
                                         const simulator::VehicleParameters& base,
                                         const std::string& base_file);

/// What a log shows of a vehicle in the plane: places among the inputs.
struct DriveColumns {
  std::array<std::optional<std::size_t>, 6> velocities{};
  std::vector<std::size_t> thrusters{};  ///< in the order of IdentifiedVehicle::thrusters
  std::vector<double> revolutions{};     ///< rev/s per unit of each thruster's input
};

/// Of an identification in the plane.
DriveColumns drive_columns(const study::PlanarColumns& columns, const study::Identification& found);

/// The rows of a log as a drive of the vehicle, for certify(): the held-out rows of the
/// configuration `only` (default: the first) where they have a stretch of a minute, else all its
/// rows. The vehicle is level, and axes without a velocity are at rest.
study::RecordedDrive recorded_drive(const IdentifiedVehicle& vehicle, const log::Dataset& data,
                                    const study::Split& split, const DriveColumns& columns,
                                    Frame frame, std::optional<int> only);

/// The same of a log of six axes.
study::RecordedDrive recorded_drive(const IdentifiedVehicle& vehicle,
                                    const study::Identification& found, const log::Dataset& data,
                                    const study::Split& split, const study::SixAxisColumns& columns,
                                    const simulator::VehicleParameters& base, Frame frame,
                                    double neutral, std::optional<int> only);

}  // namespace kelpie::format
