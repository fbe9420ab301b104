// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "bag/reader.hpp"

namespace kelpie::bag {

/// Whether a file begins as MATLAB writes: version 5 (also called 6 and 7) or 7.3.
bool begins_as_mat(std::string_view beginning);

/// Reads the arrays of a .mat file (read_mat_arrays) as topics (mat_topics), row by row in the
/// order of time. Types are matlab/Rows, and matlab/RowsWithoutTime for counted rows. Throws
/// InputError as read_mat_arrays() and mat_topics() do. Strict mode: also on damage and on rows
/// without a valid time. Recover mode: skips the row. Memory: all arrays, 8 bytes per number.
std::unique_ptr<MessageReader> read_mat(const std::filesystem::path& file, ReadMode mode,
                                        const RowTimes& times = {});

}  // namespace kelpie::bag
