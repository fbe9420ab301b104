// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "file/json.hpp"
#include "study/result.hpp"

namespace kelpie::format {

/// The object `diagnosis` of result.json (docs/reference/files.md).
file::Json diagnosis_object(const study::StreamResult& result);

}  // namespace kelpie::format
