// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "identify/six_axis_fit.hpp"
#include "kelpie/alignment/alignment.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/identify/planar_fit.hpp"
#include "log/dataset.hpp"
#include "study/certificate.hpp"
#include "study/split.hpp"

namespace kelpie::study {

/// The largest forward thrust that can be given, N per square of the thruster's unit.
inline constexpr double kMostThrust = 1e9;

/// Known quantities that give forces their unit. A log without them yields ratios to the surge
/// inertia.
struct KnownThrust {
  std::vector<std::pair<std::string, double>> thrust{};  ///< thruster, N per square of its unit
  std::optional<double> mass_kg{};                       ///< of the rigid body
  std::optional<double> surge_added_mass_kg{};           ///< surge inertia minus mass
  bool is_of_vehicle_file = false;                       ///< the added mass is
};

/// Source of the scale of forces.
enum class ScaleSource : std::uint8_t { none, thrust, inertia, vehicle_file, assumed_added_mass };

/// Measured and predicted accelerations of held-out rows, an entry per axis.
struct HeldOutFit {
  explicit HeldOutFit(std::size_t axes = 0);

  std::vector<double> times_s{};
  std::vector<std::vector<double>> measured;
  std::vector<std::vector<double>> structure;  ///< by the identified vehicle
  std::vector<std::vector<double>> free;       ///< by the same terms, unconstrained
  std::vector<double> r2;
  std::vector<double> free_r2;

  void score();  ///< Sets r2 and free_r2.
};

/// A vehicle identified from a log.
struct Identification {
  std::string source;
  std::string split;  ///< label of the split
  std::size_t training_rows = 0;
  PlanarFit planar;                 ///< in the plane
  std::optional<SixAxisFit> six{};  ///< on six axes, instead
  ScaleSource scale = ScaleSource::none;
  std::optional<double> mass_kg{};
  std::vector<std::string> targets{};
  std::vector<std::string> speed_units{};  ///< of thrusters in the plane; empty: unknown
  std::vector<double> greatest_speeds{};   ///< of thrusters, absolute, in the fit's unit
  HeldOutFit held_out{};                   ///< empty without held-out rows
  std::string alignment{};                 ///< of the commands, in words; empty: unknown
  std::vector<LagInterval> lags{};         ///< time constants of actuators, in the plane
  std::vector<std::string> fins{};         ///< inputs that are fins by their names
  bool of_poses = false;                   ///< the misfit counts errors that last (fit_poses())
  CertificateList certificates{};          ///< empty without a scale

  const ParameterFit& fit() const { return six ? static_cast<const ParameterFit&>(*six) : planar; }
};

/// Roles of a log's columns in identification.
struct PlanarColumns {
  std::array<std::size_t, kPlanarAxes> velocities{};  ///< inputs: surge, sway, yaw rate
  std::array<std::size_t, kPlanarAxes> targets{};     ///< accelerations of the velocities
  std::vector<std::size_t> thrusters{};               ///< inputs
};

/// Finds the columns. Velocities follow from `states` (the setting of that name) and their names;
/// three velocities without known names are surge, sway and yaw rate. Thrusters are the inputs
/// `wanted`, or else every remaining input. Throws InputError without surge, sway, yaw rate or a
/// thruster, and on an input without a thruster's name, or with a fin's, where `wanted` is empty.
PlanarColumns planar_columns(const log::Dataset& data, const std::string& states,
                             const std::vector<std::string>& wanted);

/// Adds a row of inputs. `follows`: without a gap behind the row before; else a stretch begins.
void add_row(PlanarRows& rows, std::span<const double> inputs, double t,
             const PlanarColumns& columns, bool follows);

/// Ascending rows as stretches without a gap or a change of configuration.
PlanarRows planar_rows(const log::Dataset& data, const std::vector<std::size_t>& rows,
                       const PlanarColumns& columns);

/// Identifies on the training rows of the configuration `only` (default: the first), and scores on
/// its held-out rows; from poses, where the log has poses (fit_poses()), without a score. Throws
/// InputError on targets that aren't accelerations of the velocities, unless it `accepts` them, and
/// on an impossible scale; also throws what fit_planar() throws.
Identification identify(const log::Dataset& data, const Split& split, const PlanarColumns& columns,
                        const KnownThrust& known, std::optional<int> only, bool accepts = false);

/// The head of an identification: log, split, names of targets, and the greatest of the commands
/// (training rows × thrusters).
Identification identification_of(const log::Dataset& data, const Split& split,
                                 std::size_t training_rows, std::span<const std::size_t> targets,
                                 std::span<const double> commands, std::size_t thrusters);

/// Gives forces their unit, as far as known (docs/howto/identify.md, "The scale").
void give_scale(const KnownThrust& known, Identification& found);

/// Inputs that are fins by their names (rudder, fin2, elevator, stern_plane, …), whose forces are
/// not in the equation.
std::vector<std::string> fins_of(const log::Dataset& data);

/// What is said of fins, for the user; empty without any.
std::string fins_text(const std::vector<std::string>& fins);

/// Calls `estimate`, and names the log, and its fins, where its rows don't suffice.
template <typename Estimate>
auto of_log(const log::Dataset& data, Estimate estimate) {
  try {
    return in_file(data.source, estimate);
  } catch (const InputError& error) {
    const std::string fins = fins_text(fins_of(data));
    throw InputError(error.place(), error.message() + (fins.empty() ? "" : "; " + fins));
  }
}

}  // namespace kelpie::study
