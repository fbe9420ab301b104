// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "format/memory_json.hpp"
#include "kelpie/model/stored_past_model.hpp"

namespace kelpie::report {

/// Past models, a line each.
std::string memory_table(const format::PastModelsFile& memory);

/// One model with the ranges of its columns.
std::string past_model_table(const format::PastModelsFile& memory, std::string_view name,
                             const StoredPastModel& model);

}  // namespace kelpie::report
