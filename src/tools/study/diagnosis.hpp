// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/vehicle/diagnosis.hpp"
#include "study/result.hpp"

namespace kelpie::study {

/// Findings and thruster health of a model after its stream.
DiagnosisResult diagnosis_of(const DynamicsModel& model);

/// Share of the nominal thrust that a thruster gave in the last minute: of Diagnosis::present(),
/// times Diagnosis::health() where known. A settled change becomes the reference of `health`, so
/// health alone tells 100 % again two minutes after a loss. `changed_s`: times of the settled
/// changes of this thruster.
struct ThrusterSinceStart {
  Cause cause;
  std::vector<double> changed_s{};
};
ThrusterSinceStart since_the_start(const Cause& present, std::span<const Cause> health,
                                   std::span<const Finding> findings);

/// Names of the targets, for DiagnosisNames.
std::vector<std::string> target_names(const StreamResult& result);

/// Authority::text with the unit of speed, where the log tells units; empty without an authority.
std::string authority_text(const StreamResult& result);

/// One line for each finding: "since 512.0 s: th2 gives 48 % of its thrust (41 to 55 %)".
std::vector<std::string> diagnosis_lines(const StreamResult& result);

/// What the thrusters can do after findings: authority_text(); empty without a finding.
std::string left_text(const StreamResult& result);

/// diagnosis_lines() and left_text(), a line each.
std::vector<std::string> finding_lines(const StreamResult& result);

}  // namespace kelpie::study
