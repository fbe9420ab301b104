// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "file/json.hpp"
#include "study/result.hpp"

namespace kelpie::format {

/// The result as JSON (UTF-8, two-space indent, a newline at the end). Every key, its unit and when
/// it is null are in docs/result.md. NaN and infinities are written as null.
std::string result_json(const study::StreamResult& result);

/// What result.json says of the log (`dataset`), for other files that say the same.
file::Json dataset_json(const study::StreamResult& result);

}  // namespace kelpie::format
