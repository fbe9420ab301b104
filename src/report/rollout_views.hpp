// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kelpie/study/open_loop_study.hpp"
#include "text_table.hpp"

namespace kelpie {

// What a terminal and a page show alike.

/// In words: data, rows, models.
std::string rollout_method(const OpenLoopResult& result);

std::vector<TextTable> rollout_tables(const OpenLoopResult& result);

}  // namespace kelpie
