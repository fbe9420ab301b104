// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "kelpie/motion/attitude.hpp"

namespace kelpie {

struct TrainedModel;

/// Least and greatest value of an input.
struct Extremes {
  double low = 0.0;
  double high = 0.0;
};

/// Accelerations a of all states at the inputs x.
using Accelerations = std::function<void(std::span<const double> x, std::span<double> a)>;

/// Ages of a rollout [s] at which practice scores the rollout.
inline constexpr std::array<double, 4> kPractisedAges{1.0, 4.0, 15.0, 60.0};
/// A value for each of these ages.
using ByAge = std::array<double, kPractisedAges.size()>;

/// A model for a Rollout, in the units of the log.
struct OpenLoop {
  Accelerations accelerations;
  std::vector<std::size_t> states;  ///< integrated inputs, one per acceleration
  std::vector<double> error;        ///< root mean square of each acceleration's error
  std::vector<double> error_time_s;  ///< s, time constant τ of an error: autocorrelation e^(−t/τ)
  std::vector<double> noise;         ///< standard deviation of each measured velocity
  std::vector<Extremes> seen;        ///< every input's range in the samples learned
  /// Root mean square of each velocity's error in a rollout by age; empty: no spread but the noise.
  std::vector<ByAge> off{};
  /// Share of each predicted change of velocity to believe, 0 to 1, by age; empty: all.
  std::vector<ByAge> kept{};
  AttitudeMotion attitude{};  ///< integrated in a rollout beside the velocities
  /// Axis of each velocity by its name, 0 to 5 for u, v, w, p, q, r; empty: names aren't known.
  std::vector<std::optional<std::size_t>> axes{};
};

/// Parts of a learned model in open loop.
enum class OpenLoopPart : std::uint8_t {
  both,     ///< by their shares
  learned,  ///< the learned model alone
  steady,   ///< the equations of motion alone
};

/// A learned model in open loop: of each axis the learned model f and its steady part, the
/// equations of motion, with the share s of the steady part that practice found,
///
///     a = s (wᵀφ + w₀) + (1 − s) f(x).
///
/// The learned model knows what the equations lack; over long times, learned short-lived effects
/// and the filter of the targets bias a rollout. Errors of both are partly independent, so a
/// mixture is often better than either.
/// Throws InputError on a model without known velocities (setting `states`) or with too few samples
/// for a steady part. The accelerations allocate nothing and are safe from many threads.
OpenLoop open_loop(const TrainedModel& model, OpenLoopPart part = OpenLoopPart::both);

}  // namespace kelpie
