// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lab/control_study.hpp"

namespace kelpie::lab {

std::string control_table(const ControlResult& result);  ///< Errors per case, for a terminal.
std::string control_json(const ControlResult& result);   ///< All results (docs/control.md).

}  // namespace kelpie::lab
