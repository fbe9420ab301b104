// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/json_node.hpp"
#include "kelpie/alignment/alignment.hpp"
#include "kelpie/model/settings.hpp"
#include "kelpie/model/trained_model.hpp"

namespace kelpie {

// Reading of model.json, and of parts that the header of a checkpoint has as well. All throw
// InputError (source, key) on invalid content.

inline constexpr const char* kModelFormat = "kelpie-model";  ///< `format` of a model.json
inline constexpr int kModelVersion = 6;                      ///< `version` as written now

/// The model of a document. `source` names the document in messages.
TrainedModel trained_model(const Json& document, const std::string& source);

/// The alignment of a model with these inputs.
Alignment read_alignment(const JsonNode& node, const std::vector<std::string>& inputs,
                         std::size_t targets);

/// Reads an object of ModelSettings::values(); removed settings are skipped.
ModelSettings read_settings(const JsonNode& node, std::size_t axes);

}  // namespace kelpie
