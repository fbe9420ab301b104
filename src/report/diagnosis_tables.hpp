// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "chart/text_table.hpp"
#include "study/result.hpp"

namespace kelpie::report {

/// What became of the vehicle and since when, with what it was told apart from.
chart::TextTable change_table(const study::StreamResult& result);

/// The effectiveness of every thruster in the last minute.
chart::TextTable health_table(const study::StreamResult& result);

}  // namespace kelpie::report
