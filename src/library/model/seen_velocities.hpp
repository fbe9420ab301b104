// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

#include "kelpie/model/open_loop.hpp"
#include "model/tuning.hpp"

namespace kelpie {

/// The range of a velocity seen in learning.
inline const Extremes& seen_velocities(const OpenLoop& model, std::size_t state) {
  return model.seen[model.states[state]];
}

/// The width of the range: bound of a standard deviation.
inline double seen_width(const OpenLoop& model, std::size_t state) {
  const Extremes& range = seen_velocities(model, state);
  return range.high - range.low;
}

/// A velocity, clamped to the range seen, widened by half the width.
inline double bounded_velocity(const Extremes& seen, double velocity) {
  const double leeway = kModelTuning.rollout.leeway * (seen.high - seen.low);
  return std::clamp(velocity, seen.low - leeway, seen.high + leeway);
}

/// Step of numerical slopes of a model; 0 for a constant velocity.
inline double slope_probe(const OpenLoop& model, std::size_t state) {
  return kModelTuning.rollout.probe * seen_width(model, state);
}

}  // namespace kelpie
