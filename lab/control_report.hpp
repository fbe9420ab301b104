// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lab/control_study.hpp"

namespace kelpie::lab {

/// Errors per case and controller, for a terminal.
std::string control_table(const ControlResult& result);

/// Everything as JSON (docs/control.md).
std::string control_json(const ControlResult& result);

/// One page with the table and a figure per case.
std::string control_html(const ControlResult& result);

}  // namespace kelpie::lab
