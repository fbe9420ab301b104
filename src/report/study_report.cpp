// SPDX-License-Identifier: Apache-2.0
#include "report/study_report.hpp"

#include <fmt/format.h>

#include "chart/page.hpp"
#include "chart/wording.hpp"
#include "kelpie/core/text.hpp"
#include "report/stream_tables.hpp"

namespace kelpie::report {
namespace {

constexpr std::size_t kTerminalRows = 30;

std::string if_any(const chart::TextTable& table, const std::string& before = "") {
  return table.rows.empty() ? "" : before + chart::html_table(table);
}

chart::Facts facts(const StudyView& study) {
  const fleet::Plan& plan = study.results.plan();
  chart::Facts list{{"study", plan.name}};
  for (const fleet::LearnerConfig& learner : plan.learners) {
    list.emplace_back("learner " + learner.name,
                      learner.set.empty() ? "as it is" : join_text(learner.set, " "));
  }
  std::string splits;
  for (const fleet::SplitOptions& split : plan.splits) {
    splits += fmt::format("{}{} (seed {})", splits.empty() ? "" : ", ", split.split, split.seed);
  }
  list.emplace_back("splits", splits);
  list.emplace_back("time of all runs", chart::duration(1e6 * study.summary.seconds));
  return list;
}

}  // namespace

std::string study_table(const StudyView& study) {
  std::string text;
  for (const std::string& sentence : study_sentences(study)) {
    text += chart::wrapped(chart::printable(sentence)) + "\n";
  }
  text += "\n" + chart::table_text(learners_view(study));
  for (const StudyMeasure& measure : {kStudyFinal, kStudyOneStep}) {
    text += chart::table_text(vehicles_view(study, measure, kTerminalRows));
  }
  if (study.change != nullptr) {
    chart::TextTable gains = gains_view(study);
    gains.rows.resize(std::min(gains.rows.size(), kTerminalRows));
    text += chart::table_text(gains);
  }
  if (const chart::TextTable failures = failures_view(study); !failures.rows.empty()) {
    text += chart::table_text(failures);
  }
  return text;
}

std::string study_html(const StudyView& study) {
  const std::string title = "kelpie: study " + study.results.plan().name;
  std::string opening = chart::heading(1, title);
  for (const std::string& sentence : study_sentences(study)) {
    opening += chart::paragraph("lead", sentence);
  }
  opening += chart::paragraph("note",
                              "Each run learns one log anew, in the order of time, and is "
                              "judged on rows held out of it. " +
                                  std::string(kBaselineNote));
  std::string vehicles =
      chart::panels(vehicle_figures(study)) + chart::html_table(vehicles_view(study, kStudyFinal));
  chart::TextTable tenth = vehicles_view(study, kStudyFinal, kMostStudyRows, &fleet::Spread::tenth);
  tenth.title = "R² on held-out rows, at the end: 10th percentile over the runs";
  std::string more;
  for (const StudyMeasure& measure : {kStudyOneStep, kStudyMean, kStudyCoverage}) {
    more += chart::html_tables({vehicles_view(study, measure)});
  }
  const bool tested = study.summary.trends > 0;
  return chart::html_page(
      title, opening,
      {{"Since the earlier study",
        study.change == nullptr
            ? ""
            : if_any(gains_view(study)) +
                  if_any(changed_runs_view(study), chart::heading(3, "Runs that have lost most"))},
       {"Learners", if_any(learners_view(study))},
       {"Vehicles", vehicles + chart::html_tables({tenth})},
       {"One step ahead, over the stream, intervals", more},
       {"From mission to mission",
        tested ? chart::panels(trend_figures(study)) + if_any(trends_view(study)) : ""},
       {"What became of vehicles", if_any(findings_view(study))},
       {"Worst runs", if_any(worst_view(study))},
       {"Failures", if_any(failures_view(study))},
       {"The study", chart::facts_table(facts(study))}});
}

}  // namespace kelpie::report
