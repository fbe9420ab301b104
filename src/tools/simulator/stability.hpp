// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "simulator/engine.hpp"

namespace kelpie::simulator {

/// A part of Fossen's equation.
enum class EngineTerm : std::uint8_t {
  added_mass,
  coriolis,
  linear_damping,
  quadratic_damping,
  restoring
};

const char* term_text(EngineTerm term);   ///< "added mass", …
std::string axis_text(std::size_t axis);  ///< "surge" to "yaw"

/// The fastest growing disturbance of a vehicle in an engine.
struct Growth {
  double per_s = 0.0;    ///< ln of the spectral radius of one step, by the step; < 0: decay
  std::size_t axis = 0;  ///< 0 to 5: the axis with the largest part in the disturbance
};

/// Growth of small disturbances of attitude, velocities and of what the engine keeps, on the axes
/// that move. Allocates.
Growth fastest_growth(const EngineRun& run, const EngineState& at);

/// What an engine's step does to a vehicle.
struct StepLimit {
  static constexpr double kMostS = 1.0;  ///< no longer step is tried

  bool stable = false;                ///< at the engine's own step
  std::optional<double> largest_s{};  ///< every step up to this one is stable; none: no step is
  std::optional<EngineTerm> term{};   ///< without this one the largest step is the longest
  std::size_t axis = 0;               ///< of the disturbance that grows first, 0 to 5
};

/// The largest stable step, to 2 %, and the term that bounds it. A step is stable where at rest and
/// at `points` no disturbance grows faster than the vehicle's own equation lets it grow, by more
/// than a fifth and 0.01/s. Steps are tried from 0.1 ms on. Cost: some 200 eigenvalue problems of
/// 21 × 21 per point. Allocates.
StepLimit step_limit(const Engine& engine, const EngineBody& body,
                     std::span<const EngineState> points);

}  // namespace kelpie::simulator
