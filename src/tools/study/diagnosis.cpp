// SPDX-License-Identifier: Apache-2.0
#include "study/diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "kelpie/core/error.hpp"
#include "kelpie/model/open_loop.hpp"
#include "kelpie/model/trained_model.hpp"
#include "kelpie/vehicle/diagnosis.hpp"

namespace kelpie::study {

namespace {

// With the commands driven as ranges; none where a command doesn't pass 0, its place at rest.
std::optional<Authority> authority_of(const DynamicsModel& model) {
  try {
    const std::vector<Extremes> seen = open_loop(model.trained(), OpenLoopPart::steady).seen;
    std::vector<CommandRange> ranges;
    for (const Cause& thruster : model.diagnosis()->present()) {
      const Extremes& range = seen[thruster.place];
      ranges.push_back({.input = thruster.place,
                        .least = std::min(range.low, 0.0),
                        .most = std::max(range.high, 0.0)});
    }
    if (ranges.empty()) {
      return std::nullopt;
    }
    return Authority(*model.diagnosis(), ranges);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace

DiagnosisResult diagnosis_of(const DynamicsModel& model) {
  DiagnosisResult result;
  const Diagnosis* const diagnosis = model.diagnosis();
  if (diagnosis == nullptr) {
    result.why_not =
        "it isn't known which inputs are the velocities that the targets accelerate: put them "
        "first and name them u, v, r or the like, or name them with the setting states; and "
        "there may be no more than 128 terms";
    return result;
  }
  result.findings = model.findings();
  result.health = diagnosis->health();
  result.has_reference = diagnosis->knows_thrust();
  if (result.has_reference) {
    result.present = diagnosis->present();
  }
  if (model.ready()) {
    result.authority = authority_of(model);
  }
  return result;
}

ThrusterSinceStart since_the_start(const Cause& present, std::span<const Cause> health,
                                   std::span<const Finding> findings) {
  ThrusterSinceStart thruster{present};
  if (const auto last = std::ranges::find(health, present.place, &Cause::place);
      last != health.end()) {
    const double half = std::hypot(0.5 * (last->upper - last->lower) * present.size,
                                   0.5 * (present.upper - present.lower) * last->size);
    thruster.cause.size *= last->size;
    thruster.cause.lower = thruster.cause.size - half;
    thruster.cause.upper = thruster.cause.size + half;
  }
  for (const Finding& finding : findings) {
    for (const Cause& cause : std::span(finding.causes).first(finding.count)) {
      const bool is_of_thruster =
          cause.kind == CauseKind::all_thrusters ||
          (cause.kind == CauseKind::thruster && cause.place == present.place);
      if (finding.settled && is_of_thruster) {
        thruster.changed_s.push_back(finding.since_s);
      }
    }
  }
  return thruster;
}

std::vector<std::string> target_names(const StreamResult& result) {
  std::vector<std::string> names;
  std::ranges::transform(result.axes, std::back_inserter(names), &AxisResult::name);
  return names;
}

std::string authority_text(const StreamResult& result) {
  if (!result.diagnosis.authority) {
    return "";
  }
  const bool in_metres =
      std::ranges::find(result.axes, "m s^-2", &AxisResult::unit) != result.axes.end();
  const std::vector<std::string> targets = target_names(result);
  return result.diagnosis.authority->text({result.input_names, targets}, in_metres ? "m/s" : "");
}

std::vector<std::string> diagnosis_lines(const StreamResult& result) {
  const std::vector<std::string> targets = target_names(result);
  std::vector<std::string> lines;
  for (const Finding& finding : result.diagnosis.findings) {
    lines.push_back(fmt::format("since {:.1f} s: {}", finding.since_s,
                                finding_text(finding, {result.input_names, targets})));
  }
  return lines;
}

std::string left_text(const StreamResult& result) {
  return result.diagnosis.findings.empty() ? "" : authority_text(result);
}

std::vector<std::string> finding_lines(const StreamResult& result) {
  std::vector<std::string> lines = diagnosis_lines(result);
  if (const std::string left = left_text(result); !left.empty()) {
    lines.push_back("left at the end: " + left);
  }
  return lines;
}

}  // namespace kelpie::study
