// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "file/json.hpp"
#include "study/result.hpp"

namespace kelpie::format {

/// What result.json says of the vehicle (`diagnosis`, docs/result.md).
file::Json diagnosis_object(const study::StreamResult& result);

}  // namespace kelpie::format
