// SPDX-License-Identifier: Apache-2.0
#include "report/diagnosis_tables.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "chart/wording.hpp"
#include "study/diagnosis.hpp"

namespace kelpie::report {
namespace {

std::string per_cent(double share) {
  return std::isfinite(share) ? fmt::format("{:.0f} %", 100.0 * share) : "–";
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
                          compared ? fmt::format("{:.0f}", finding.margin) : ""});
  }
  return table;
}

chart::TextTable health_table(const study::StreamResult& result) {
  chart::TextTable table{
      .title = "Thrusters in the last minute",
      .head = {"thruster", "gives", "at least", "at most", "changed"},
      .rows = {},
      .notes = {"Of its thrust at the start, with an interval of 90 % (docs/howto/diagnosis.md)."},
      .left = {0, 4}};
  for (const Cause& present : result.diagnosis.present) {
    const auto& [cause, times] =
        study::since_the_start(present, result.diagnosis.health, result.diagnosis.findings);
    std::string changed;
    for (const double time_s : times) {
      changed += fmt::format("{}at {:.0f} s", changed.empty() ? "" : ", ", time_s);
    }
    table.rows.push_back({result.input_names[cause.place], per_cent(cause.size),
                          per_cent(cause.lower), per_cent(cause.upper),
                          changed.empty() ? "–" : changed});
  }
  return table;
}

}  // namespace kelpie::report
