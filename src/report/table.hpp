// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "study/result.hpp"

namespace kelpie::report {

/// The result for a terminal: the split, the rows, then one line per axis. No line is wider than
/// 100 columns (long names are cut). `colour` adds ANSI escapes: bold heads, red for R² below 0
/// and for an interruption. "–" stands for what was not measured.
std::string result_table(const study::StreamResult& result, bool colour = false);

}  // namespace kelpie::report
