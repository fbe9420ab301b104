// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "file/json.hpp"
#include "kelpie/alignment/alignment.hpp"

namespace kelpie::format {

// Parts of both model.json and the header of a checkpoint; model/model_json.hpp reads both.

file::Json current_json(const Current& current);        ///< Null in still water.
file::Json alignment_json(const Alignment& alignment);  ///< Null where nothing is done.
file::Json actuators_json(
    const Alignment& alignment);  ///< An object per command; or an empty list.

}  // namespace kelpie::format
