// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "chart/text_table.hpp"
#include "fleet/earlier_study.hpp"
#include "fleet/results.hpp"
#include "fleet/summary.hpp"

namespace kelpie::report {

/// The content of a page about a study.
struct StudyView {
  const fleet::Results& results;
  const fleet::StudySummary& summary;
  const fleet::StudyChange* change = nullptr;  ///< since an earlier study; null: no earlier study
};

inline constexpr std::size_t kMostStudyRows = 200;  ///< of a table on a page

/// The runs and the best learners, in sentences.
std::vector<std::string> study_sentences(const StudyView& study);

/// How often each learner is best, and its cost; vehicles and axes together.
chart::TextTable learners_view(const StudyView& study);

/// A measure of an axis, for learners and baselines.
struct StudyMeasure {
  std::string_view title;
  fleet::Spread fleet::LearnerSummary::*learner = nullptr;
  fleet::Spread fleet::AxisSummary::*least_squares = nullptr;  ///< or null
  fleet::Spread fleet::AxisSummary::*other = nullptr;          ///< another baseline, or null
  std::string_view other_name = {};
};
inline constexpr StudyMeasure kStudyFinal{
    "R² on held-out rows, at the end: median over the runs", &fleet::LearnerSummary::r2_final,
    &fleet::AxisSummary::least_squares, &fleet::AxisSummary::mean, "mean"};
inline constexpr StudyMeasure kStudyOneStep{"R² one step ahead: median over the runs",
                                            &fleet::LearnerSummary::one_step,
                                            &fleet::AxisSummary::least_squares_one_step,
                                            &fleet::AxisSummary::last_value_one_step, "last value"};
inline constexpr StudyMeasure kStudyMean{
    "R² on held-out rows, mean over the stream: median over the runs",
    &fleet::LearnerSummary::r2_mean,
    nullptr,
    nullptr,
    {}};
inline constexpr StudyMeasure kStudyCoverage{
    "Share of samples inside their interval: median over the runs",
    &fleet::LearnerSummary::coverage,
    nullptr,
    nullptr,
    {}};

/// A row per vehicle and axis, a column per learner and baseline: medians, or the 10th percentile.
/// Of more than `most` rows the worst of the first learner.
chart::TextTable vehicles_view(const StudyView& study, const StudyMeasure& measure,
                               std::size_t most = kMostStudyRows,
                               double fleet::Spread::*of = &fleet::Spread::median);

/// Gains and losses since the earlier study. Requires `change`.
chart::TextTable gains_view(const StudyView& study);
chart::TextTable changed_runs_view(const StudyView& study);  ///< The largest losses.

chart::TextTable trends_view(const StudyView& study);  ///< The tested trends.
/// How many vehicles changed, in one sentence.
std::string findings_headline(const StudyView& study);

std::size_t findings_count(const StudyView& study);  ///< of all missions

/// A row per vehicle with findings: missions with findings, and the last finding.
chart::TextTable vehicle_findings_view(const StudyView& study);

chart::TextTable findings_view(const StudyView& study);  ///< A row per finding.
chart::TextTable worst_view(const StudyView& study);     ///< The worst runs of the first learner.
chart::TextTable failures_view(const StudyView& study);  ///< Runs without a result.

/// Medians of the learners by vehicle, a figure for each axis.
std::vector<std::string> vehicle_figures(const StudyView& study);

/// R² from mission to mission of the vehicles with the most significant trends.
std::vector<std::string> trend_figures(const StudyView& study);

/// For a terminal: the runs, the learners over every vehicle, R² by vehicle and axis.
std::string study_table(const StudyView& study);

/// One page: as study_table() with figures, changes since an earlier study, trends over missions,
/// and the worst runs. The size grows with the vehicles, up to kMostStudyRows, not with the
/// missions.
std::string study_html(const StudyView& study);

}  // namespace kelpie::report
