// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "file/json.hpp"
#include "kelpie/model/alignment.hpp"
#include "kelpie/model/settings.hpp"

namespace kelpie::format {

// Parts of both model.json and the header of a checkpoint. Reading throws InputError (file, key) on
// invalid content.

file::Json alignment_json(const Alignment& alignment);  ///< Null where nothing is done.
file::Json actuators_json(
    const Alignment& alignment);  ///< An object per command; or an empty list.

/// The alignment of a model with these inputs.
Alignment read_alignment(const file::JsonNode& node, const std::vector<std::string>& inputs);

/// Reads an object of ModelSettings::values(); removed settings are skipped.
ModelSettings read_settings(const file::JsonNode& node, std::size_t axes);

}  // namespace kelpie::format
