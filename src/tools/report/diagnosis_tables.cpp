// SPDX-License-Identifier: Apache-2.0
#include "report/diagnosis_tables.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "chart/wording.hpp"
#include "report/tuning.hpp"
#include "study/diagnosis.hpp"

namespace kelpie::report {
namespace {

std::string per_cent(double share) {
  return std::isfinite(share) ? chart::grouped(std::lround(100.0 * share)) + " %" : "–";
}

// Whether the last minute tells the share: a share that was never estimated has no width.
bool is_told(const Cause& share) {
  const double width = share.upper - share.lower;
  return width > 0.0 && width <= kTuning.told_thrust;
}

}  // namespace

chart::TextTable change_table(const study::StreamResult& result) {
  chart::TextTable table{
      .title = "What changed",
      .head = {"since", "found", "what", "explained", "margin"},
      .rows = {},
      .notes = {"Found: how much later. Explained: share of what a refit without restriction "
                "explains. Margin: log likelihood by which it is better than the next best cause; "
                "intervals are of 90 % (docs/howto/diagnosis.md)."},
      .left = {2}};
  const std::vector<std::string> targets = study::target_names(result);
  for (const Finding& finding : result.diagnosis.findings) {
    const bool judged = finding.state != FindingState::looking;
    const bool compared = judged && finding.causes[0].kind != CauseKind::frozen;
    table.rows.push_back({chart::time_text(finding.since_s) + " s",
                          fmt::format("{:.0f} s", finding.found_s - finding.since_s),
                          finding_text(finding, {result.input_names, targets}),
                          judged ? per_cent(finding.explained) : "",
                          compared ? chart::grouped(std::llround(finding.margin)) : ""});
  }
  return table;
}

chart::TextTable health_table(const study::StreamResult& result) {
  chart::TextTable table{.title = "Thrusters in the last minute",
                         .head = {"thruster", "gives", "at least", "at most", "changed"},
                         .rows = {},
                         .notes = {},
                         .left = {0, 4}};
  std::vector<std::string> untold;
  for (const Cause& present : result.diagnosis.present) {
    const auto& [cause, times] =
        study::since_the_start(present, result.diagnosis.health, result.diagnosis.findings);
    std::string changed;
    for (const double time_s : times) {
      changed += fmt::format("{}at {:.0f} s", changed.empty() ? "" : ", ", time_s);
    }
    if (!is_told(cause) && times.empty()) {
      untold.push_back(result.input_names[cause.place]);
      continue;
    }
    table.rows.push_back({result.input_names[cause.place], per_cent(cause.size),
                          per_cent(cause.lower), per_cent(cause.upper),
                          changed.empty() ? "–" : changed});
  }
  if (!table.rows.empty()) {
    table.notes.emplace_back(
        "Of its thrust at the start, with an interval of 90 % (docs/howto/diagnosis.md).");
  }
  if (!untold.empty()) {
    table.notes.push_back(
        fmt::format("The last minute does not tell the thrust of {}.", chart::list_text(untold)));
  }
  return table;
}

}  // namespace kelpie::report
