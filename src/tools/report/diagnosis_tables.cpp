// SPDX-License-Identifier: Apache-2.0
#include "report/diagnosis_tables.hpp"

#include <fmt/format.h>

#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "chart/wording.hpp"
#include "study/diagnosis.hpp"

namespace kelpie::report {
namespace {

std::string per_cent(double share) {
  return std::isfinite(share) ? fmt::format("{:.0f} %", 100.0 * share) : "–";
}

// A settled change became the reference of the health: brings the health back to the thrust at the
// start, and tells when it changed.
std::string since_the_start(Cause& health, const std::vector<Finding>& findings) {
  std::string changed;
  for (const Finding& finding : findings) {
    for (const Cause& cause : std::span(finding.causes).first(finding.count)) {
      if (finding.settled && cause.kind == CauseKind::thruster && cause.place == health.place) {
        health.size *= cause.size;
        health.lower *= cause.lower;
        health.upper *= cause.upper;
        changed += fmt::format("{}at {:.0f} s", changed.empty() ? "" : ", ", finding.since_s);
      }
    }
  }
  return changed.empty() ? "–" : changed;
}

}  // namespace

chart::TextTable change_table(const study::StreamResult& result) {
  chart::TextTable table{
      .title = "What changed",
      .head = {"since", "found", "what", "explained", "margin"},
      .rows = {},
      .notes = {"Found: how much later. Explained: share of what a refit without restriction "
                "explains. Margin: log likelihood by which it is better than the next best cause; "
                "intervals are of 90 % (docs/diagnosis.md)."},
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
      .notes = {"Of its thrust at the start, with an interval of 90 % (docs/diagnosis.md)."},
      .left = {0, 4}};
  for (Cause cause : result.diagnosis.health) {
    const std::string changed = since_the_start(cause, result.diagnosis.findings);
    table.rows.push_back({result.input_names[cause.place], per_cent(cause.size),
                          per_cent(cause.lower), per_cent(cause.upper), changed});
  }
  return table;
}

}  // namespace kelpie::report
