// SPDX-License-Identifier: Apache-2.0
#include "report/sampling_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "chart/text_table.hpp"
#include "core/text.hpp"

namespace kelpie::report {
namespace {

void add_lags(std::vector<std::string>& notes, const log::TopicAlignment& lags, double until_s) {
  notes.push_back(fmt::format(
      "lags estimated from the first {} whole rows (up to {:.1f} s): they explain {:.1f} % of the "
      "accelerations, {:.1f} % without",
      lags.rows, until_s, 100.0 * lags.explained, 100.0 * lags.explained_at_zero));
  std::vector<std::string> common;
  for (const log::TopicLag& topic : lags.topics) {
    if (!topic.is_own && lags.topics.size() > 1) {
      common.push_back(topic.topic);
    }
  }
  if (!common.empty()) {
    notes.push_back("the common lag, for one of their own explained hardly more: " +
                    join_text(common, ", "));
  }
}

// "R² of the accelerations on folds: 0.41, 0.52, 0.98".
void add_window(std::vector<std::string>& notes, const log::SamplingReport& report) {
  std::string text = fmt::format("poses: velocities and accelerations over windows of {:.3g} s",
                                 2.0 * report.pose_half_s);
  if (report.window) {
    const auto& tried = report.window->tried;
    const auto best =
        std::ranges::find(tried, report.window->half_s, &log::PoseWindowChoice::Tried::half_s);
    std::vector<std::string> shares;
    for (const double share : best->explained) {
      shares.push_back(fmt::format("{:.2f}", share));
    }
    text += fmt::format(
        ", found among {:.3g} to {:.3g} s: least squares explains {} of the accelerations",
        2.0 * tried.front().half_s, 2.0 * tried.back().half_s, join_text(shares, ", "));
  }
  notes.push_back(text);
}

void add_notes(std::vector<std::string>& notes, const log::SamplingReport& report) {
  if (report.pose_half_s > 0.0) {
    add_window(notes, report);
  }
  if (report.lags) {
    add_lags(notes, *report.lags, report.lag_until_s);
  }
  notes.push_back(fmt::format("{} rows, {} whole in {} stretch{}", report.rows, report.whole_rows,
                              report.segments, report.segments == 1 ? "" : "es"));
}

}  // namespace

std::string faults_text(const SignalFaults& faults) {
  std::vector<std::string> parts;
  const auto add = [&](std::size_t count, const std::string& what) {
    if (count > 0) {
      parts.push_back(fmt::format("{} {}", count, what));
    }
  };
  add(faults.no_value, "without value");
  add(faults.duplicates, "with the stamp before");
  add(faults.steps_back, "out of order");
  add(faults.late, "too late");
  add(faults.no_stamp, "without a time");
  if (faults.gaps > 0) {
    add(faults.gaps,
        fmt::format("silence{}, longest {:.2f} s at {:.1f} s", faults.gaps > 1 ? "s" : "",
                    faults.longest_gap_s, faults.longest_gap_at_s));
  }
  if (faults.stuck > 0) {
    add(faults.stuck, fmt::format("stretch{} of one value, longest {:.1f} s at {:.1f} s",
                                  faults.stuck > 1 ? "es" : "", faults.longest_stuck_s,
                                  faults.longest_stuck_at_s));
  }
  return join_text(parts, ", ");
}

std::string sampling_table(const log::SamplingReport& report) {
  if (report.sources.empty()) {
    return "";
  }
  chart::TextTable table{.title = {},
                         .head = {"signal", "samples", "rate/Hz", "lag/s", "found"},
                         .rows = {},
                         .left = {0, 4},
                         .whole = true};
  for (const log::SamplingReport::OfSource& source : report.sources) {
    table.rows.push_back({source.name, fmt::format("{}", source.faults.samples),
                          fmt::format("{:.2f}", source.rate_hz),
                          source.lag_origin.empty() ? "–" : fmt::format("{:.3f}", source.lag_s),
                          faults_text(source.faults)});
  }
  for (const log::SamplingReport::OfDerived& derived : report.derived) {
    table.notes.push_back(fmt::format("{}: {} points, delay {:.3f} s, noise × {:.3g} /s",
                                      derived.name, derived.info.points, derived.info.delay_s,
                                      derived.info.noise_gain));
  }
  add_notes(table.notes, report);
  return chart::table_text(table);
}

std::string sampling_notes(const log::SamplingReport& report) {
  if (report.sources.empty()) {
    return "";
  }
  std::vector<std::string> notes;
  const auto faulty = std::ranges::count_if(
      report.sources, [](const auto& source) { return !faults_text(source.faults).empty(); });
  if (faulty > 0) {
    notes.push_back(
        fmt::format("{} of {} signals have silences, stretches of one value or other "
                    "faults: --verbose shows each",
                    faulty, report.sources.size()));
  }
  add_notes(notes, report);
  return join_text(notes, "\n") + "\n\n";
}

}  // namespace kelpie::report
