// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "bag/bag.hpp"
#include "bag/mat_topics.hpp"

namespace kelpie::bag {

/// Whether this is a file of MATLAB. False when it can't be read, and for a pipe.
bool is_mat(const std::filesystem::path& file);

/// Reads the arrays of a .mat file (read_mat_arrays) as topics (mat_topics), row by row in the
/// order of time. Types are matlab/Rows, and matlab/RowsWithoutTime where rows are only counted.
/// Throws what these two throw. Strict mode: also where something is damaged or a row's time is
/// none. Recover mode: leaves it out.
/// Memory: all arrays, 8 bytes per number.
std::unique_ptr<BagReader> read_mat(const std::filesystem::path& file, ReadMode mode,
                                    const RowTimes& times = {});

}  // namespace kelpie::bag
