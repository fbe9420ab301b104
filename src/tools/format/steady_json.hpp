// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "file/json.hpp"
#include "kelpie/model/trained_model.hpp"
#include "model/steady_part.hpp"

namespace kelpie::format {

/// The steady part of an axis in model.json (docs/rollouts.md); null where unknown.
file::Json steady_json(const SteadyModel& steady);

/// Reads the steady parts of every axis, where the settings name velocities among the inputs.
/// Requires a model with names, settings and axes. Throws InputError (file, key).
void read_steady_parts(const std::vector<file::JsonNode>& axes, TrainedModel& model);

}  // namespace kelpie::format
