// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "file/json.hpp"
#include "kelpie/model/alignment.hpp"
#include "kelpie/model/settings.hpp"

namespace kelpie::format {

/// What model.json and the header of a checkpoint have in common. Reading throws InputError (file,
/// key) on what doesn't fit.

file::Json alignment_json(const Alignment& alignment);  ///< Null where nothing is shifted.

/// The shift of a model of these inputs.
Alignment read_alignment(const file::JsonNode& node, const std::vector<std::string>& inputs);

/// An object of ModelSettings::values(); settings that no longer exist are passed over.
ModelSettings read_settings(const file::JsonNode& node, std::size_t axes);

}  // namespace kelpie::format
