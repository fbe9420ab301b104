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

/// A model as a Rollout takes it. All in the log's own units.
struct OpenLoop {
  Accelerations accelerations;
  std::vector<std::size_t> states;   ///< the inputs that are integrated, one per acceleration
  std::vector<double> error;         ///< root mean square of each acceleration's error
  std::vector<double> error_time_s;  ///< how long an error lasts: autocorrelation e^(−t/this)
  std::vector<double> noise;         ///< standard deviation of each velocity as measured
  std::vector<Extremes> seen;        ///< every input's range in the samples learned
};

/// How long a rollout believes what the learned model says beyond its steady part. Found on the
/// training rows of the real log (docs/rollouts.md).
inline constexpr double kFadeS = 3.0;

/// A learned model in open loop: at first what it predicts, and with growing age more and more its
/// steady part alone,
///
///     a = m f(x) + (1 − m) (wᵀφ + w₀),   m = e^(−age/fade_s).
///
/// Near the start the model knows best; on the long run, what it learned of the moment and of the
/// filter that made its targets leads astray. An infinite fade is the model alone.
/// Throws InputError on a fade that isn't positive, and on a model that doesn't know which inputs
/// are velocities (setting `states`) or has seen too few samples to have a steady part.
/// The accelerations allocate nothing; they may be called from many threads.
OpenLoop open_loop(const TrainedModel& model, double fade_s = kFadeS);

}  // namespace kelpie
