// SPDX-License-Identifier: Apache-2.0
#include "format/diagnosis_json.hpp"

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

Json finding_object(const Finding& finding, const DiagnosisNames& names) {
  const std::span<const Cause> causes(finding.causes);
  const bool judged = finding.state != FindingState::looking;
  const bool compared = judged && finding.causes[0].kind != CauseKind::frozen;
  return {{"since_s", number(finding.since_s)},
          {"found_s", number(finding.found_s)},
          {"told_s", number(finding.told_s)},
          {"state", state_name(finding.state)},
          {"settled", finding.settled},
          {"text", finding_text(finding, names)},
          {"causes", file::list(causes.first(judged ? finding.count : 0),
                                [&](const Cause& cause) { return cause_object(cause, names); })},
          {"rival", compared ? cause_object(finding.rival, names) : Json(nullptr)},
          {"evidence", compared ? number(finding.evidence) : Json(nullptr)},
          {"margin", compared ? number(finding.margin) : Json(nullptr)},
          {"explained", judged ? number(finding.explained) : Json(nullptr)}};
}

}  // namespace

Json diagnosis_object(const study::StreamResult& result) {
  const std::vector<std::string> targets = study::target_names(result);
  const DiagnosisNames names{result.input_names, targets};
  return {{"why_not", file::text_or_null(result.diagnosis.why_not)},
          {"findings",
           file::list(result.diagnosis.findings,
                      [&](const Finding& finding) { return finding_object(finding, names); })},
          {"health", file::list(result.diagnosis.health,
                                [&](const Cause& cause) { return cause_object(cause, names); })}};
}

}  // namespace kelpie::format
