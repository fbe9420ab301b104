// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "file/json.hpp"
#include "model/steady_part.hpp"

namespace kelpie::format {

/// The steady part of an axis in model.json (docs/method/open_loop.md); null where unknown.
file::Json steady_json(const SteadyModel& steady);

}  // namespace kelpie::format
