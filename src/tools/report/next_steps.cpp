// SPDX-License-Identifier: Apache-2.0
#include "report/next_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <ranges>
#include <span>

#include "report/tuning.hpp"

namespace kelpie::report {
namespace {

// Whether thrusters alone changed and have their nominal thrust: rows of before tell the vehicle.
bool is_return(const Finding& finding) {
  return std::ranges::all_of(
      std::span(finding.causes).first(finding.count), [](const Cause& cause) {
        return cause.kind == CauseKind::thruster && cause.lower <= 1.0 && cause.upper >= 1.0;
      });
}

// The time of the last named change that enough rows follow, unless it is a return.
std::optional<double> last_change_s(const study::StreamResult& result) {
  if (result.axes.empty() || result.axes.front().one_step.time_s.empty()) {
    return std::nullopt;
  }
  const std::vector<double>& times = result.axes.front().one_step.time_s;
  for (const Finding& finding : std::views::reverse(result.diagnosis.findings)) {
    if (finding.state == FindingState::named) {
      const auto since = std::ranges::lower_bound(times, finding.since_s);
      const bool enough = times.end() - since >= kTuning.rows_since;
      return enough && !is_return(finding) ? std::optional(finding.since_s) : std::nullopt;
    }
  }
  return std::nullopt;
}

}  // namespace

std::vector<NextStep> after_learning(const study::StreamResult& result, const LogWords& log,
                                     const std::string& model) {
  std::vector<NextStep> next;
  const std::optional<double> since_s = last_change_s(result);
  if (since_s && log.learning) {
    next.push_back({fmt::format("kelpie learn {} --since {:.12g} --out out/since{}", log.file,
                                *since_s, *log.learning),
                    "the changed vehicle alone: compare R²"});
  }
  if (result.diagnosis.why_not.empty() && log.judging) {
    next.push_back({"kelpie rollout " + log.file + *log.judging + " --model " + model,
                    "how the error grows in open loop"});
  }
  next.push_back(
      {"kelpie predict LOG" + log.reading + " --model " + model, "predictions for another log"});
  next.push_back({"kelpie learn LOG" + log.reading + " --from " + model,
                  "goes on with another log of the vehicle"});
  return next;
}

std::vector<NextStep> after_poor_model(const std::string& file, const std::string& log) {
  return {{"kelpie inspect " + file, "what each column holds, and how often"},
          {"kelpie compare " + log, "whether a simpler model predicts better"}};
}

}  // namespace kelpie::report
