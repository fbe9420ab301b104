// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>

#include "kelpie/model/open_loop.hpp"
#include "model/tuning.hpp"

namespace kelpie {

/// The range in which a velocity was seen.
inline const Extremes& seen_velocities(const OpenLoop& model, std::size_t state) {
  return model.seen[model.states[state]];
}

/// Its width: what a standard deviation may grow to.
inline double seen_width(const OpenLoop& model, std::size_t state) {
  const Extremes& range = seen_velocities(model, state);
  return range.high - range.low;
}

/// A velocity, held within what was seen, widened by half its width.
inline double bounded_velocity(const OpenLoop& model, std::size_t state, double velocity) {
  const Extremes& range = seen_velocities(model, state);
  const double leeway = kModelTuning.rollout.leeway * (range.high - range.low);
  return std::clamp(velocity, range.low - leeway, range.high + leeway);
}

/// Step of the differences that tell a model's slope; 0 where the velocity never changed.
inline double slope_probe(const OpenLoop& model, std::size_t state) {
  return kModelTuning.rollout.probe * seen_width(model, state);
}

}  // namespace kelpie
