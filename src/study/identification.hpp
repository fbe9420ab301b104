// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kelpie/motion/planar_fit.hpp"
#include "log/dataset.hpp"
#include "study/split.hpp"

namespace kelpie::study {

/// What gives forces their unit. A log alone tells ratios to the surge inertia.
struct KnownThrust {
  std::vector<std::pair<std::string, double>> thrust{};  ///< thruster, N per square of its unit
  std::optional<double> mass_kg{};                       ///< of the rigid body
  std::optional<double> surge_added_mass_kg{};  ///< with the mass: what the surge inertia is
};

/// Where the scale comes from.
enum class ScaleSource : std::uint8_t { none, thrust, inertia, assumed_added_mass };

/// Without an added mass in surge, it is taken for this share of the mass, give or take its error.
inline constexpr double kAssumedAddedShare = 0.2;
inline constexpr double kAssumedAddedError = 0.15;

/// Measured and predicted accelerations of held-out rows.
struct HeldOutFit {
  std::vector<double> times_s{};
  std::array<std::vector<double>, kPlanarAxes> measured{};
  std::array<std::vector<double>, kPlanarAxes> structure{};  ///< by the identified vehicle
  std::array<std::vector<double>, kPlanarAxes> free{};       ///< by the same terms, untied
  PlanarVector r2{};
  PlanarVector free_r2{};
};

/// A vehicle identified from a log.
struct Identification {
  std::string source;
  std::string split;  ///< its label
  std::size_t training_rows = 0;
  PlanarFit fit;
  ScaleSource scale = ScaleSource::none;
  std::optional<double> mass_kg{};
  std::array<std::string, kPlanarAxes> targets{};
  std::vector<std::string> speed_units{};  ///< of thrusters as the log has them; empty: not told
  std::vector<double> greatest_speeds{};   ///< of thrusters, sizes, in the log's unit
  HeldOutFit held_out{};                   ///< empty where the split holds out nothing
};

/// Which columns of a log are what, for identification.
struct PlanarColumns {
  std::array<std::size_t, kPlanarAxes> velocities{};  ///< among inputs: surge, sway, yaw rate
  std::array<std::size_t, kPlanarAxes> targets{};     ///< their accelerations
  std::vector<std::size_t> thrusters{};               ///< among inputs
};

/// Finds them: velocities by `states` (as the setting of that name) and their names, or as surge,
/// sway, yaw where there are three without; thrusters are the other inputs, or those of `wanted`.
/// Throws InputError where surge, sway or yaw is missing, no thruster is there, or an input has no
/// thruster's name and `wanted` doesn't say what it is.
PlanarColumns planar_columns(const log::Dataset& data, const std::string& states,
                             const std::vector<std::string>& wanted);

/// The rows of a list (going up) as stretches without a gap or a change of configuration.
PlanarRows planar_rows(const log::Dataset& data, const std::vector<std::size_t>& rows,
                       const PlanarColumns& columns);

/// Identifies on the training rows of the configuration `only` (else of the first), judges on its
/// held-out ones. Throws InputError where targets aren't accelerations of the velocities, as
/// fit_planar() does, and on a scale that can't be had.
Identification identify(const log::Dataset& data, const Split& split, const PlanarColumns& columns,
                        const KnownThrust& wish, std::optional<int> only);

}  // namespace kelpie::study
