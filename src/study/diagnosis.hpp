// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/motion/wording.hpp"
#include "study/result.hpp"

namespace kelpie::study {

/// What a model has to say of its vehicle.
DiagnosisResult diagnosis_of(const DynamicsModel& model);

/// The targets, as DiagnosisNames has them.
std::vector<std::string> target_names(const StreamResult& result);

/// "since 512.0 s: th2 gives 48 % of its thrust (41 to 55 %)", one for each change.
std::vector<std::string> diagnosis_lines(const StreamResult& result);

}  // namespace kelpie::study
