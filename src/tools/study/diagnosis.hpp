// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/motion/diagnosis.hpp"
#include "study/result.hpp"

namespace kelpie::study {

/// Findings and thruster health of a model after its stream.
DiagnosisResult diagnosis_of(const DynamicsModel& model);

/// Names of the targets, for DiagnosisNames.
std::vector<std::string> target_names(const StreamResult& result);

/// One line for each finding: "since 512.0 s: th2 gives 48 % of its thrust (41 to 55 %)".
std::vector<std::string> diagnosis_lines(const StreamResult& result);

}  // namespace kelpie::study
