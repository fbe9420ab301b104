// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace kelpie {

struct TrainedModel;

/// Least and greatest value of an input.
struct Extremes {
  double low = 0.0;
  double high = 0.0;
};

/// Accelerations a of all states at the inputs x, `age_s` after the start of a rollout.
using Accelerations =
    std::function<void(std::span<const double> x, double age_s, std::span<double> a)>;

/// A model for a Rollout, in the units of the log.
struct OpenLoop {
  Accelerations accelerations;
  std::vector<std::size_t> states;  ///< integrated inputs, one per acceleration
  std::vector<double> error;        ///< root mean square of each acceleration's error
  std::vector<double> error_time_s;  ///< s, time constant τ of an error: autocorrelation e^(−t/τ)
  std::vector<double> noise;         ///< standard deviation of each measured velocity
  std::vector<Extremes> seen;        ///< every input's range in the samples learned
};

/// Time constant [s] of the weight of the learned model against its steady part. Chosen on the
/// training rows of the real log (docs/rollouts.md).
inline constexpr double kFadeS = 3.0;

/// A learned model in open loop: the model's prediction at first, its steady part with growing age,
///
///     a = m f(x) + (1 − m) (wᵀφ + w₀),   m = e^(−age/fade_s).
///
/// The learned model is the better predictor near the start; over long times, learned short-lived
/// effects and the filter of the targets bias a rollout. An infinite fade is the model alone.
/// Throws InputError on a fade that isn't positive, and on a model without known velocities
/// (setting `states`) or with too few samples for a steady part. The accelerations allocate
/// nothing and are safe from many threads.
OpenLoop open_loop(const TrainedModel& model, double fade_s = kFadeS);

}  // namespace kelpie
