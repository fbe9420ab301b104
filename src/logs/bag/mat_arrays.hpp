// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "kelpie/core/error.hpp"

namespace kelpie::bag {

/// Receives damage, and throws where reading must end (MessageReader::lose).
using LoseDamage = std::function<void(const InputError&)>;

/// Receives a variable that is not read, with the reason (MessageReader::leave_out).
using LeaveOut = std::function<void(const std::string&)>;

/// An array of real numbers, converted from any numeric class.
struct MatArray {
  std::string path;            ///< "u"; of a struct "log.imu.u"; of a cell array "runs_2.u"
  std::size_t rows = 0;        ///< with three dimensions or more: product of all but the last
  std::size_t columns = 0;     ///< the last dimension
  std::vector<double> values;  ///< column by column
};

/// Reads all arrays of real numbers in a .mat file with libmatio, in a child process, because
/// libmatio and HDF5 trust the sizes in a file and crash on some damaged files. The child has 256
/// MB of memory and 64 bytes per byte of the file, 8 s and 1 s per MB; a crash and a limit are
/// damage. Of version 5 the outermost elements and zlib's checksums are checked. Structs and cells
/// are taken apart; a field that is one number in every struct of an array gives an array of these
/// numbers; signals of Simulink (`values` with a `label`) are named by label. Texts, sparse arrays
/// and complex arrays are skipped; objects, and cells never filled, go to `leave_out`. Names become
/// letters, digits and underscores. Reports damage (file, offset or variable) to `lose` and reads
/// the rest as far as possible. Throws InputError (file): missing file, another format, no readable
/// array, structs more than 16 deep, kelpie built without libmatio. Memory: 8 bytes per number, and
/// the largest variable twice.
std::vector<MatArray> read_mat_arrays(const std::filesystem::path& file, const LoseDamage& lose,
                                      const LeaveOut& leave_out);

}  // namespace kelpie::bag
