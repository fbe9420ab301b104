// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "kelpie/online/regressor.hpp"

namespace kelpie::study {

/// Every prediction that a model made one step ahead, just before its sample was learned, in the
/// order of the stream. All of the same length, in the target's own unit.
struct OneStep {
  std::vector<double> time_s;
  std::vector<int> configuration;
  std::vector<std::size_t> samples;  ///< training samples shown until then, this one included
  std::vector<double> truth;
  std::vector<double> predicted;
  std::vector<double> lower;  ///< ends of the interval then in force; infinite where there is none
  std::vector<double> upper;
};

/// R² of those of the predictions that were made at `samples`, in their order; NaN where one of
/// them was not made.
double one_step_r2(const OneStep& steps, std::span<const std::size_t> samples);

/// Samples in a window of running_coverage(), and after a start or switch before windows count.
inline constexpr std::size_t kCoverageWindow = 500;

/// How well intervals kept what they promise.
struct Coverage {
  std::size_t samples = 0;  ///< predicted with an interval; without any, all else is NaN
  double share = std::numeric_limits<double>::quiet_NaN();  ///< of them inside their interval
  /// Least share in any kCoverageWindow samples in a row of one configuration, not counting its
  /// first kCoverageWindow samples; NaN where no configuration is long enough.
  double lowest = std::numeric_limits<double>::quiet_NaN();
  double mean_width = std::numeric_limits<double>::quiet_NaN();
  double median_width = std::numeric_limits<double>::quiet_NaN();
};

Coverage coverage_of(const OneStep& steps);  ///< Over all steps.

/// For every step, the share of samples inside their interval among the last kCoverageWindow of the
/// same configuration; NaN where there aren't so many in a row with an interval.
std::vector<double> running_coverage(const OneStep& steps);

/// Predictions whose novelty is within a tenth of its range, and how good they were.
struct NoveltyBin {
  double from = 0.0;  ///< from <= novelty < to; the last bin has 1 as well
  double to = 0.0;
  std::size_t rows = 0;  ///< without any, the rest is NaN
  double rms_error = std::numeric_limits<double>::quiet_NaN();
  double held = std::numeric_limits<double>::quiet_NaN();  ///< share inside the interval
};

/// Ten bins, or none where no prediction has a novelty; those without one are passed over.
/// Requires as many predictions as truths.
std::vector<NoveltyBin> errors_by_novelty(std::span<const double> truth,
                                          std::span<const Prediction> predicted);

}  // namespace kelpie::study
