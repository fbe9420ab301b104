// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "study/result.hpp"

namespace kelpie::report {

/// How a result begins on a terminal: the log, the split, the rows.
std::string heading_text(const study::StreamResult& result);

/// The result for a terminal: the split, the rows, then one line per axis. No line is wider than
/// 100 columns (long names are cut). "–" stands for what was not measured.
std::string result_table(const study::StreamResult& result);

}  // namespace kelpie::report
