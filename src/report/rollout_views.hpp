// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "chart/text_table.hpp"
#include "study/open_loop_study.hpp"

namespace kelpie::report {

// What a terminal and a page show alike.

/// In words: data, rows, models.
std::string rollout_method(const study::OpenLoopResult& result);

std::vector<chart::TextTable> rollout_tables(const study::OpenLoopResult& result);

}  // namespace kelpie::report
