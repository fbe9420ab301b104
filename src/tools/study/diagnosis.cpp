// SPDX-License-Identifier: Apache-2.0
#include "study/diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "kelpie/motion/diagnosis.hpp"

namespace kelpie::study {

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
  return result;
}

ThrusterSinceStart since_the_start(const Cause& health, std::span<const Finding> findings) {
  ThrusterSinceStart thruster{health};
  for (const Finding& finding : findings) {
    for (const Cause& cause : std::span(finding.causes).first(finding.count)) {
      if (finding.settled && cause.kind == CauseKind::thruster && cause.place == health.place) {
        thruster.cause.size *= cause.size;
        thruster.cause.lower *= cause.lower;
        thruster.cause.upper *= cause.upper;
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

std::vector<std::string> diagnosis_lines(const StreamResult& result) {
  const std::vector<std::string> targets = target_names(result);
  std::vector<std::string> lines;
  for (const Finding& finding : result.diagnosis.findings) {
    lines.push_back(fmt::format("since {:.1f} s: {}", finding.since_s,
                                finding_text(finding, {result.input_names, targets})));
  }
  return lines;
}

}  // namespace kelpie::study
