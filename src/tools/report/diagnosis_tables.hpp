// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "chart/text_table.hpp"
#include "study/result.hpp"

namespace kelpie::report {

/// The changes of the vehicle with time, cause and excluded causes.
chart::TextTable change_table(const study::StreamResult& result);

/// The effectiveness of every thruster in the last minute.
chart::TextTable health_table(const study::StreamResult& result);

}  // namespace kelpie::report
