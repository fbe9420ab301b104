// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "kelpie/svr/regressor.hpp"

namespace kelpie::study {

/// All predictions of a model one step ahead, each before learning its sample, in the order of the
/// stream. The lists have the same length; values are in the target's unit.
struct OneStep {
  std::vector<double> time_s;
  std::vector<int> configuration;
  std::vector<std::size_t> samples;  ///< training samples shown so far, this sample included
  std::vector<double> truth;
  std::vector<double> predicted;
  std::vector<double> lower;  ///< lower end of the interval; infinite without an interval
  std::vector<double> upper;
};

/// R² of the predictions at `samples`, ascending; NaN where the model lacks a prediction.
double one_step_r2(const OneStep& steps, std::span<const std::size_t> samples);

/// Samples in a window of running_coverage(); after a start or switch, windows count only after as
/// many samples.
inline constexpr std::size_t kCoverageWindow = 500;

/// Share of samples inside their interval, and width of the intervals. NaN without samples.
struct Coverage {
  std::size_t samples = 0;                                  ///< predicted with an interval
  double share = std::numeric_limits<double>::quiet_NaN();  ///< of samples inside
  /// Least share in any window of one configuration, without the first kCoverageWindow samples; NaN
  /// where every configuration is too short.
  double lowest = std::numeric_limits<double>::quiet_NaN();
  double mean_width = std::numeric_limits<double>::quiet_NaN();
  double median_width = std::numeric_limits<double>::quiet_NaN();
};

Coverage coverage_of(const OneStep& steps);  ///< Over all steps.

/// For every step, the share of samples inside their interval among the last kCoverageWindow steps;
/// NaN where these aren't all of one configuration and with an interval.
std::vector<double> running_coverage(const OneStep& steps);

/// Accuracy of predictions whose novelty lies in one tenth of [0, 1]. NaN without rows.
struct NoveltyBin {
  double from = 0.0;  ///< from <= novelty < to; the last bin includes 1
  double to = 0.0;
  std::size_t rows = 0;
  double rms_error = std::numeric_limits<double>::quiet_NaN();
  double held = std::numeric_limits<double>::quiet_NaN();  ///< share inside the interval
};

/// Ten bins; empty where every prediction lacks a novelty. Predictions without novelty are skipped.
/// Requires as many predictions as truths.
std::vector<NoveltyBin> errors_by_novelty(std::span<const double> truth,
                                          std::span<const Prediction> predicted);

}  // namespace kelpie::study
