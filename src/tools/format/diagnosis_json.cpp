// SPDX-License-Identifier: Apache-2.0
#include "format/diagnosis_json.hpp"

#include <optional>
#include <string>
#include <vector>

#include "study/diagnosis.hpp"

namespace kelpie::format {
namespace {

using file::Json;
using file::number;

Json cause_object(const Cause& cause, const DiagnosisNames& names) {
  return {{"kind", kind_name(cause.kind)},
          {"column", file::text_or_null(cause_column(cause, names))},
          {"size", number(cause.size)},
          {"lower", number(cause.lower)},
          {"upper", number(cause.upper)}};
}

// Causes of a finding, with the share of a thruster before the change.
Json changed_objects(const Finding& finding, const DiagnosisNames& names) {
  Json causes = Json::array();
  for (std::size_t i = 0; i < finding.count; ++i) {
    const Cause& cause = finding.causes[i];
    causes.push_back(cause_object(cause, names));
    causes.back()["before"] =
        cause.kind == CauseKind::thruster ? number(finding.before[i]) : Json(nullptr);
  }
  return causes;
}

Json finding_object(const Finding& finding, const DiagnosisNames& names) {
  const bool judged = finding.state != FindingState::looking;
  const bool compared = judged && finding.causes[0].kind != CauseKind::frozen;
  return {{"since_s", number(finding.since_s)},
          {"found_s", number(finding.found_s)},
          {"told_s", number(finding.told_s)},
          {"state", state_name(finding.state)},
          {"settled", finding.settled},
          {"text", finding_text(finding, names)},
          {"causes", judged ? changed_objects(finding, names) : Json::array()},
          {"rival", compared ? cause_object(finding.rival, names) : Json(nullptr)},
          {"evidence", compared ? number(finding.evidence) : Json(nullptr)},
          {"margin", compared ? number(finding.margin) : Json(nullptr)},
          {"explained", judged ? number(finding.explained) : Json(nullptr)}};
}

Json authority_object(const study::StreamResult& result, const DiagnosisNames& names) {
  const Authority& authority = *result.diagnosis.authority;
  Json axes = Json::array();
  for (std::size_t i = 0; i < authority.axes().size(); ++i) {
    const AxisAuthority& axis = authority.axes()[i];
    axes.push_back({{"name", names.targets[i]},
                    {"left", number(axis.left())},
                    {"most", number(axis.most)},
                    {"least", number(axis.least)},
                    {"nominal_most", number(axis.nominal_most)},
                    {"nominal_least", number(axis.nominal_least)},
                    {"alone_most", number(axis.alone_most)},
                    {"alone_least", number(axis.alone_least)}});
  }
  const auto thruster = [&](const ThrusterEffect& one) {
    return Json{{"column", names.inputs[one.range.input]},
                {"share", number(one.share)},
                {"range", Json::array({one.range.least, one.range.most})},
                {"ahead", file::numbers(one.ahead)},
                {"ahead_width", file::numbers(one.ahead_width)},
                {"astern", file::numbers(one.astern)},
                {"astern_width", file::numbers(one.astern_width)}};
  };
  return {{"text", study::authority_text(result)},
          {"axes", axes},
          {"thrusters", file::list(authority.thrusters(), thruster)},
          {"singular_values", file::numbers(authority.singular_values())},
          {"nominal_singular_values", file::numbers(authority.nominal_singular_values())},
          {"held_current", number(authority.held_current())}};
}

}  // namespace

Json diagnosis_object(const study::StreamResult& result) {
  const std::vector<std::string> targets = study::target_names(result);
  const DiagnosisNames names{result.input_names, targets};
  return {
      {"why_not", file::text_or_null(result.diagnosis.why_not)},
      {"authority", result.diagnosis.authority ? authority_object(result, names) : Json(nullptr)},
      {"findings",
       file::list(result.diagnosis.findings,
                  [&](const Finding& finding) { return finding_object(finding, names); })},
      {"health", file::list(result.diagnosis.health,
                            [&](const Cause& cause) { return cause_object(cause, names); })}};
}

}  // namespace kelpie::format
