// SPDX-License-Identifier: Apache-2.0
#include "motion/archives.hpp"

#include "kelpie/core/scaling.hpp"

namespace kelpie {
namespace {

template <typename Kind>
void visit_kind(Archive& archive, Kind& kind, std::size_t kinds) {
  auto number = static_cast<std::size_t>(kind);
  archive.whole(number, 0, kinds - 1);
  kind = static_cast<Kind>(number);
}

}  // namespace

void visit_cause(Archive& archive, Cause& cause) {
  visit_kind(archive, cause.kind, kCauseKinds);
  archive.whole(cause.place, 0, kMostInputs - 1);
  for (double* const number : {&cause.size, &cause.lower, &cause.upper}) {
    archive.any_number(*number);
  }
}

void visit_finding(Archive& archive, Finding& finding) {
  for (double* const time : {&finding.since_s, &finding.found_s, &finding.told_s}) {
    archive.number(*time);
  }
  visit_kind(archive, finding.state, kFindingStates);
  archive.flag(finding.settled);
  archive.whole(finding.count, 0, finding.causes.size());
  for (Cause& cause : finding.causes) {
    visit_cause(archive, cause);
  }
  visit_cause(archive, finding.rival);
  for (double* const number : {&finding.evidence, &finding.margin, &finding.explained}) {
    archive.any_number(*number);
  }
}

}  // namespace kelpie
