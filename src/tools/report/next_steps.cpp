// SPDX-License-Identifier: Apache-2.0
#include "report/next_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <ranges>
#include <set>
#include <span>
#include <utility>

#include "motion/signal_names.hpp"
#include "motion/states.hpp"
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

// The axis of a target by the name of its velocity; none: not known.
std::optional<std::size_t> axis_of(const study::StreamResult& result, std::size_t target) {
  const auto setting =
      std::ranges::find(result.settings, "states", &std::pair<std::string, std::string>::first);
  const std::vector<std::size_t> states =
      find_states(setting == result.settings.end() ? "auto" : setting->second, result.input_names,
                  result.axes.size());
  return target < states.size() ? velocity_axis(result.input_names[states[target]]) : std::nullopt;
}

// Whether `kelpie plan` takes the log: velocities of the plane by name, all other inputs thrusters.
bool can_be_planned(const study::StreamResult& result) {
  std::set<std::size_t> axes;
  for (std::size_t target = 0; target < result.axes.size(); ++target) {
    axes.insert(axis_of(result, target).value_or(kAxisTexts.size()));
  }
  return axes.contains(0) && axes.contains(1) && axes.contains(5) &&
         std::ranges::all_of(result.input_names, [](const std::string& name) {
           return velocity_axis(name) || names_thruster(name);
         });
}

// A cause as `kelpie plan --apart` names causes; empty: unknown there.
std::string apart_name(const study::StreamResult& result, const Cause& cause) {
  using enum CauseKind;
  const std::optional<std::size_t> axis = axis_of(result, cause.place);
  const bool is_planar = axis && (*axis < 2 || *axis == 5);
  switch (cause.kind) {
    case thruster:
      return result.input_names[cause.place];
    case all_thrusters:
      return "all_thrusters";
    case load:
      return "load";
    case drag:
      return is_planar ? fmt::format("{}_drag", kAxisTexts[*axis]) : "";
    case force:
      return is_planar ? fmt::format("{}_{}", kAxisTexts[*axis], *axis == 5 ? "moment" : "force")
                       : "";
    default:
      return "";
  }
}

// The option with the size of a change of a share or factor; empty: a force.
std::string change_option(const Finding& finding) {
  const Cause& cause = finding.causes[0];
  if (cause.kind == CauseKind::force) {
    return "";
  }
  const double before = cause.kind == CauseKind::thruster ? finding.before[0] : 1.0;
  const double percent = before > 0.0 ? 100.0 * std::abs(cause.size / before - 1.0) : 100.0;
  return fmt::format(" --change {:.0f}", std::clamp(percent, 1.0, 100.0));
}

// The drive that tells the candidates of the last change apart, where both are known to plans.
std::optional<NextStep> telling_drive(const study::StreamResult& result, const LogWords& log) {
  const std::vector<Finding>& findings = result.diagnosis.findings;
  if (!log.planning || findings.empty() || findings.back().state != FindingState::ambiguous ||
      !can_be_planned(result)) {
    return std::nullopt;
  }
  const std::string first = apart_name(result, findings.back().causes[0]);
  const std::string second = apart_name(result, findings.back().rival);
  if (first.empty() || second.empty() || first == second) {
    return std::nullopt;
  }
  return NextStep{fmt::format("kelpie plan {}{} --apart {},{}{}", log.file, *log.planning, first,
                              second, change_option(findings.back())),
                  "a drive that tells the two causes apart"};
}

}  // namespace

std::vector<NextStep> after_learning(const study::StreamResult& result, const LogWords& log,
                                     const std::string& model) {
  std::vector<NextStep> next;
  if (std::optional<NextStep> drive = telling_drive(result, log)) {
    next.push_back(*std::move(drive));
  }
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
