// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "chart/text_table.hpp"
#include "study/open_loop_study.hpp"

namespace kelpie::report {

/// In words: data, rows, models; and the tables, for a terminal and for a page.
std::string rollout_method(const study::OpenLoopResult& result);
std::vector<chart::TextTable> rollout_tables(const study::OpenLoopResult& result);

/// For a terminal: R² of the velocities by horizon, model by model; dead reckoning; coverage.
std::string rollout_table(const study::OpenLoopResult& result);

/// One page: R² by horizon, an example beside the measurement, and the tables.
std::string rollout_html(const study::OpenLoopResult& result);

}  // namespace kelpie::report
