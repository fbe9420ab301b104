// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "chart/figure.hpp"
#include "lab/reproduction.hpp"

namespace kelpie::lab {

// What the figures, tables and verdicts of a reproduction are made of.

/// R² over samples shown: mean, least and greatest of all seeds. NaN where no model was in service.
struct MeanCurve {
  std::vector<chart::Point> mean;
  std::vector<chart::Point> low;
  std::vector<chart::Point> high;
};
MeanCurve mean_curve(const ContenderRuns& runs, std::size_t axis);  ///< Of one axis of a contender.

/// The contender of that key, or null.
const ContenderRuns* find_contender(const StreamStudy& study, std::string_view key);

/// The study of that key and split ("random", "blocks"), or null.
const StreamStudy* find_study(const Reproduction& result, std::string_view key,
                              std::string_view split_kind);

/// R² at the end of a stage, mean of all seeds.
double stage_r2(const ContenderRuns& runs, std::size_t axis, std::size_t stage);

/// How many stages the stream has: runs of one configuration.
std::size_t stages_of(const StreamStudy& study);

/// R² of the off-line baseline trained on that stage's configuration, on its own held-out rows; NaN
/// where there is none.
double baseline_r2(const StreamStudy& study, std::size_t axis, std::size_t stage);

/// Means over all axes, NaN without any.
double mean_stage_r2(const ContenderRuns& runs, std::size_t stage);
double mean_baseline_r2(const StreamStudy& study, std::size_t stage);  ///< As baseline_r2().

/// From the first sample that was forgotten because the buffer was full, without the 1,000 samples
/// after a switch (and none before 1,000): how R² moves there. Mean of all seeds and axes in which
/// anything was forgotten; `looks` is 0 when nothing was.
struct Steadiness {
  std::size_t looks = 0;
  double jitter = 0.0;   ///< root mean square of the change of R² from look to look
  double deepest = 0.0;  ///< how far the lowest look lies below the median
};
Steadiness steadiness(const ContenderRuns& runs);  ///< Of one contender.

/// The same looks, judged over those of another contender's: where `reference` had begun to forget.
Steadiness steadiness(const ContenderRuns& runs, const ContenderRuns& reference);

/// What happens at a switch to the mean over axes and seeds: R² at the last look before, the lowest
/// within 1,000 samples after, and at the end of the new stage.
struct SwitchEffect {
  double before = 0.0;
  double lowest = 0.0;
  double end = 0.0;
};
/// One for every switch, in their order.
std::vector<SwitchEffect> switch_effects(const StreamStudy& study, const ContenderRuns& runs);

}  // namespace kelpie::lab
