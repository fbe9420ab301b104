// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace kelpie {

/// The behavioural constants of the learner of one axis, by mechanism, with unit and origin. Sizes
/// of windows and blocks stand with their arrays. "Training rows" are the training rows of the real
/// and simulated logs of docs/measured/accuracy.md; "by hand" means without a recorded measurement.
struct OnlineTuning {
  /// ErrorCorrelation.
  struct Evidence {
    double first = 10.0;        ///< rows per independent sample, before they are known
    std::int64_t least = 64;    ///< errors before they are known: by hand
    std::int64_t every = 8;     ///< errors between two looks: by hand
    double keep = 0.9995;       ///< per error: a memory of 2,000 errors, by hand
    double least_alike = 1e-3;  ///< smallest autocorrelation
  } evidence;

  /// MemberShares; docs/method/posterior.md, Mixture: 36 axes of nine vehicles.
  struct Shares {
    double learning_rate = 5.0;  ///< η
    double keep = 0.98;          ///< λ per block: a memory of 50 blocks
    double least_share = 1e-9;
    double clip = 10.0;         ///< largest error of one sample [standard deviations]
    double least_usual = 1e-6;  ///< smallest usual loss [variances]
    double caution = 0.5;       ///< κ of a member's disagreement (FunctionMix)
  } shares;

  /// SeenRange.
  struct Range {
    double margin = 0.1;        ///< of targets, added on either side, of the width: by hand
    double term_margin = 0.5;   ///< of physics terms, the same: docs/method/posterior.md
    double early_margin = 1.0;  ///< the same for few targets [standard deviations]: by hand
  } range;

  /// Disturbance; docs/method/uncertainty.md: training rows, of little influence.
  struct Disturbances {
    double lambda = 0.999;     ///< weight of a sample relative to the next
    double replaced = 10.0;    ///< forgetting per sample is limited to this multiple of its gain
    double least_known = 0.1;  ///< prior of a weight [samples]
    double far = 10.0;         ///< usual errors of a suspect target
    double heaviest = 10.0;    ///< usual errors of full weight
    double around = 3.0;  ///< usual errors around the range of f, y₋₁ and 2 y₋₁ − y₋₂
    double outside = 0.25;       ///< largest excess over the targets' range, of the range
    double absurd = 10.0;        ///< ranges outside the range where a target is clipped
    double next = 1.5;           ///< usual steps up to the next sample
    double counted_step = 3.0;   ///< usual steps where a step is clipped
    double step_pace = 0.05;     ///< rate of the usual step per sample
    double trust_memory = 50.0;  ///< suspect targets
  } disturbance;

  /// ConformalInterval; docs/method/uncertainty.md: windows of 100, 250 and 500 on training rows.
  struct Interval {
    double stretch = 500.0;       ///< samples over which the best expert may change (section 3)
    std::size_t min_errors = 30;  ///< errors before an interval: by hand
  } interval;

  /// RecursiveLeastSquares: by hand.
  struct LeastSquares {
    int most_velocities = 6;
    std::int64_t weak_look_every = 16;  ///< samples between two searches for weak terms
  } least_squares;
};

inline constexpr OnlineTuning kOnline{};

}  // namespace kelpie
