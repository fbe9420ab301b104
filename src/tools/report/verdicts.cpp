// SPDX-License-Identifier: Apache-2.0
#include "report/verdicts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "chart/text_table.hpp"
#include "chart/wording.hpp"
#include "core/text.hpp"
#include "kelpie/core/setting.hpp"
#include "report/identification_report.hpp"
#include "report/recommendation.hpp"
#include "report/tune_report.hpp"
#include "report/tuning.hpp"

namespace kelpie::report {
namespace {

using study::ContenderKind;
using study::Contest;

std::string paragraph(const std::string& text) {
  return text.empty() ? "" : chart::wrapped(chart::safe_text(text)) + "\n";
}

std::string short_name(const std::string& file) {
  return chart::shortened(chart::file_names(file), kTuning.longest_log);
}

chart::TextTable contest_table(const study::Comparison& comparison) {
  const study::StreamResult& kelpie = comparison.contests.front().stream;
  chart::TextTable table{.title = fmt::format("R² on {} held-out rows ({})",
                                              chart::grouped(kelpie.held_out_rows), kelpie.split),
                         .head = {"contender"},
                         .rows = {},
                         .left = {0},
                         .whole = true};
  for (const study::AxisResult& axis : kelpie.axes) {
    table.head.push_back(chart::shortened(axis.name, chart::kLongestName));
  }
  table.head.emplace_back("an update");
  for (const Contest& contest : comparison.contests) {
    if (contest.kind == ContenderKind::last_value) {
      continue;  // it tells nothing of held-out rows
    }
    table.rows.push_back({contest.name});
    for (const study::AxisResult& axis : contest.stream.axes) {
      table.rows.back().push_back(chart::decimal(axis.r2_final));
    }
    table.rows.back().push_back(contest.update_us > 0.0 ? chart::duration(contest.update_us) : "–");
  }
  return table;
}

}  // namespace

std::string comparison_verdict(const study::Comparison& comparison) {
  const study::StreamResult& kelpie = comparison.contests.front().stream;
  std::string text =
      fmt::format("Compared {} models on {} rows of {}\n", comparison.contests.size(),
                  chart::grouped(kelpie.training_rows), short_name(kelpie.source));
  text +=
      paragraph(settings_advice(comparison)) + "\n" + chart::table_text(contest_table(comparison));
  for (const Advice& advice : all_advice(comparison)) {
    text += advice.is_news ? paragraph(advice.text) : "";
  }
  return text;
}

namespace {

// Iterations of the solver per row; NaN: not measured on the last rung.
double work_of(const study::TuneResult& result, const std::string& axis,
               const std::string& settings) {
  for (const study::TrialResult& trial : result.trials) {
    if (trial.axis == axis && trial.settings == settings && trial.rung + 1 == result.rungs.size()) {
      return trial.iterations_per_row;
    }
  }
  return NAN;
}

}  // namespace

std::string tune_verdict(const study::TuneResult& result) {
  chart::TextTable table{.title = "Score on training rows (a stretch is scored, then learned)",
                         .head = {"target", "at the start", "tuned", "gain", "least squares",
                                  "tuned: iterations per row"},
                         .rows = {},
                         .left = {0},
                         .whole = true};
  for (std::size_t i = 0; i < result.axes.size(); ++i) {
    const study::TunedAxis& axis = result.axes[i];
    const double work = work_of(result, axis.name, study::settings_of(result.tuned, i));
    table.rows.push_back({chart::shortened(axis.name, chart::kLongestName),
                          chart::decimal(axis.all.base), chart::decimal(axis.all.tuned),
                          chart::decimal(axis.all.gain()), chart::decimal(axis.all.least_squares),
                          std::isfinite(work) ? chart::significant(work) : "–"});
  }
  std::string text = fmt::format("Searched settings in {} evaluations on {} {}\n",
                                 chart::grouped(result.evaluations.size()), result.logs.size(),
                                 result.logs.size() == 1 ? "log" : "logs");
  if (result.interrupted) {
    text += "INTERRUPTED: the same command resumes the search\n";
  } else {
    text += paragraph(gain_sentence(result) +
                      (any_gain(result) ? " The best of many is partly lucky: see whether R² on "
                                          "held-out rows follows."
                                        : ""));
  }
  return text + "\n" + chart::table_text(table) + paragraph(worse_text(result));
}

namespace {

// Errors need no more digits.
std::string rounded(double error) {
  return fmt::format("{:.2g}", error);
}

}  // namespace

std::string rollout_verdict(const study::OpenLoopResult& result) {
  const study::OpenLoopScore& model = result.scores.front();
  const auto held =
      std::ranges::find(result.scores, study::kVelocityHeld, &study::OpenLoopScore::name);
  chart::TextTable table{
      .title = {}, .head = {"after", "starts"}, .rows = {}, .left = {0}, .whole = true};
  for (std::size_t i = 0; i < result.states.size(); ++i) {
    const std::string unit =
        result.units[i].empty() ? "" : " [" + chart::unit_text(result.units[i]) + "]";
    table.head.push_back("error of\n" + chart::shortened(result.states[i], chart::kLongestName) +
                         unit);
  }
  table.head.emplace_back("R²");
  table.head.push_back("R²,\n" + held->name);
  const auto all_r2 = [](const study::HorizonScore& horizon) {
    std::vector<std::string> texts;
    std::ranges::transform(horizon.r2, std::back_inserter(texts), chart::decimal);
    return join_text(texts, " ");
  };
  std::vector<std::string> within;
  double told_s = 0.0;
  for (std::size_t h = 0; h < model.horizons.size(); ++h) {
    const study::HorizonScore& horizon = model.horizons[h];
    table.rows.push_back({fmt::format("{:g} s", horizon.seconds), chart::grouped(horizon.starts)});
    for (const double rms : horizon.rms) {
      table.rows.back().push_back(rounded(rms));
    }
    table.rows.back().push_back(all_r2(horizon));
    table.rows.back().push_back(all_r2(held->horizons[h]));
    if (horizon.starts > 0 && horizon.seconds <= kTuning.told_horizon_s) {
      told_s = horizon.seconds;
      within.clear();
      for (std::size_t i = 0; i < horizon.rms.size(); ++i) {
        within.push_back(
            fmt::format("{} within {}{}", result.states[i], rounded(horizon.rms[i]),
                        result.units[i].empty() ? "" : " " + chart::unit_text(result.units[i])));
      }
    }
  }
  std::string text =
      paragraph(fmt::format("Rolled out {} on {}: {} rows, {}", short_name(result.model),
                            short_name(result.source), chart::grouped(result.rows), result.split));
  text += within.empty() ? "No stretch of rows is long enough for a rollout.\n"
                         : paragraph(fmt::format("After {:g} s: {} (root mean square).", told_s,
                                                 join_text(within, ", ")));
  return text + "\n" + chart::table_text(table);
}

std::string identification_verdict(const study::Identification& found) {
  const auto told = std::ranges::count_if(found.fit().parameters, [](const FittedParameter& one) {
    return one.state != ParameterState::not_told;
  });
  std::string text;
  if (const std::vector<double>& r2 = found.held_out.r2; !found.held_out.times_s.empty()) {
    const auto worst = static_cast<std::size_t>(std::ranges::min_element(r2) - r2.begin());
    std::vector<std::string> others;
    for (std::size_t axis = 0; axis < found.targets.size(); ++axis) {
      if (axis != worst) {
        others.push_back(found.targets[axis] + " " + chart::decimal(r2[axis]));
      }
    }
    text = paragraph(
        fmt::format("R² of the identified vehicle on held-out rows: {} {} at worst, {}",
                    found.targets[worst], chart::decimal(r2[worst]), join_text(others, ", ")));
  }
  text += fmt::format("Identified {} of {} parameters from {} rows of {}\n", told,
                      found.fit().parameters.size(), chart::grouped(found.training_rows),
                      short_name(found.source));
  for (const std::string& remark : identification_remarks(found)) {
    text += paragraph(remark);
  }
  return text;
}

std::string study_verdict(const StudyView& study) {
  std::vector<std::string> sentences = study_sentences(study);
  std::string text = paragraph(sentences.front());
  const chart::TextTable findings = findings_view(study);
  const std::size_t shown = std::min(findings.rows.size(), kTuning.most_changes);
  for (std::size_t i = 0; i < shown; ++i) {
    const std::vector<std::string>& row = findings.rows[i];
    text += paragraph(fmt::format("vehicle {}, {}: {}", row[0], row[1], row[2]));
  }
  if (const std::size_t more = findings_count(study) - shown; shown == 0) {
    text += "vehicles: no cause of a change was found\n";
  } else if (more > 0) {
    text += fmt::format("and {} more findings\n", more);
  }
  for (std::size_t i = 1; i < sentences.size(); ++i) {
    text += paragraph(sentences[i]);
  }
  if (!study.results.failures().empty()) {
    text += paragraph("WARNING: " + study.results.failures().begin()->second);
  }
  return text;
}

}  // namespace kelpie::report
