// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "chart/figure.hpp"
#include "lab/reproduction.hpp"

namespace kelpie::lab {

/// R² over samples shown: mean, least and greatest of the seeds. NaN without a model in service.
struct MeanCurve {
  std::vector<chart::Point> mean;
  std::vector<chart::Point> low;
  std::vector<chart::Point> high;
};
MeanCurve mean_curve(const ContenderRuns& runs, std::size_t axis);  ///< Of an axis.

/// The contender with the key, or null.
const ContenderRuns* find_contender(const StreamStudy& study, std::string_view key);

/// R² at the end of a stage, mean of the seeds.
double stage_r2(const ContenderRuns& runs, std::size_t axis, std::size_t stage);

/// Number of stages of the stream: runs of a configuration.
std::size_t stages_of(const StreamStudy& study);

/// R² of the off-line baseline of the stage's configuration, on the configuration's held-out rows;
/// NaN without a baseline.
double baseline_r2(const StreamStudy& study, std::size_t axis, std::size_t stage);

/// Means over the axes, NaN without axes.
double mean_stage_r2(const ContenderRuns& runs, std::size_t stage);
double mean_baseline_r2(const StreamStudy& study, std::size_t stage);  ///< As baseline_r2().

/// Movement of R² from the first sample forgotten by a full buffer on, without the 1,000 samples
/// after the start and after each switch. Mean of the seeds and axes with forgotten samples;
/// `looks` is 0 without forgotten samples.
struct Steadiness {
  std::size_t looks = 0;
  double jitter = 0.0;   ///< root mean square of the change of R² from look to look
  double deepest = 0.0;  ///< median less lowest look
};
/// Looks count from the first sample forgotten by `reference`.
Steadiness steadiness(const ContenderRuns& runs, const ContenderRuns& reference);

/// Mean R² over axes and seeds at a switch: at the last look before, the lowest within 1,000
/// samples after, and at the end of the new stage.
struct SwitchEffect {
  double before = 0.0;
  double lowest = 0.0;
  double end = 0.0;
};
/// An entry per switch, in order.
std::vector<SwitchEffect> switch_effects(const StreamStudy& study, const ContenderRuns& runs);

}  // namespace kelpie::lab
