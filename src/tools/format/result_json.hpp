// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "file/json.hpp"
#include "study/result.hpp"

namespace kelpie::format {

/// The result as JSON (UTF-8, two-space indent, a newline at the end). reference/files.md lists
/// every key, its unit and its nulls. NaN and infinities are written as null.
std::string result_json(const study::StreamResult& result);

/// The object `dataset` of result.json, for other files too.
file::Json dataset_json(const study::StreamResult& result);

}  // namespace kelpie::format
