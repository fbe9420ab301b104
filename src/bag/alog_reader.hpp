// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "bag/bag.hpp"

namespace kelpie::bag {

/// Whether a file begins as MOOS's pLogger writes it: lines of comment, with LOGSTART.
bool begins_as_alog(std::span<const std::byte> bytes);

/// Reads an .alog file of MOOS: lines of time, variable, source and value. `bytes` is the file's
/// content and has to outlive the reader; messages call it `file`. A topic per variable, whoever
/// wrote it: field `value`, a number where most of its values are (others are NaN), and text
/// otherwise; field `source`, text. Times count from LOGSTART. Text may go on in the lines that
/// follow; comments and empty lines are passed over.
/// Throws InputError (file, line) on a line that is none of these, a file that ends within a line,
/// a LOGSTART that is no time. Recover mode: leaves the line out; without LOGSTART times count
/// from 0.
/// Cost: every line is looked at twice. Memory: the topics.
std::unique_ptr<BagReader> read_alog(std::span<const std::byte> bytes, const std::string& file,
                                     ReadMode mode);

/// The same of a file, which is mapped into memory and must not shrink meanwhile.
std::unique_ptr<BagReader> read_alog(const std::filesystem::path& file, ReadMode mode);

}  // namespace kelpie::bag
