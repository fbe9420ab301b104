// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "bag/reader.hpp"

namespace kelpie::bag {

/// Whether a file begins as pLogger of MOOS writes: comment lines with LOGSTART.
bool begins_as_alog(std::string_view beginning);

/// Reads an .alog file of MOOS: lines of time, variable, source and value. `bytes` is the content
/// and has to outlive the reader; messages call it `file`. A topic per variable, for all sources:
/// field `value`, a number if most values are numbers (NaN for the rest), else text; field
/// `source`, text. Times count from LOGSTART. A text may continue on the following lines; comments
/// and empty lines are skipped.
/// Throws InputError (file, line) on any other line, an unfinished last line, a LOGSTART without a
/// time. Recover mode: skips the line; times count from 0 without LOGSTART.
/// Cost: two passes over the lines. Memory: the topics.
std::unique_ptr<MessageReader> read_alog(std::span<const std::byte> bytes, const std::string& file,
                                         ReadMode mode);

}  // namespace kelpie::bag
