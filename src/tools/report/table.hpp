// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "study/result.hpp"

namespace kelpie::report {

/// The first lines of a result on a terminal: the log, the split, the rows.
std::string heading_text(const study::StreamResult& result);

/// The result for a terminal: the split, the rows, then one line per axis. No line is wider than
/// 100 columns (long names are cut). "–": not measured.
std::string result_table(const study::StreamResult& result);

}  // namespace kelpie::report
