// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "kelpie/core/error.hpp"

namespace kelpie::bag {

/// Whether a file begins as MATLAB writes it, version 5 (also called 6 and 7) or 7.3.
bool begins_as_mat(std::string_view beginning);

/// An array of real numbers, of whatever kind they are in the file.
struct MatArray {
  std::string path;            ///< "u"; of a struct "log.imu.u"; of a cell array "runs_2.u"
  std::size_t rows = 0;        ///< of three dimensions or more: the product of all but the last
  std::size_t columns = 0;     ///< the last dimension
  std::vector<double> values;  ///< column by column
};

/// All arrays of real numbers in a .mat file, as libmatio reads them. Structs and cells are taken
/// apart; a struct array whose field is one number everywhere gives an array of these; signals of
/// Simulink (`values` with a `label`) are called by their labels. Texts, sparse and complex arrays
/// and objects are left out. Names become letters, digits and underscores.
/// `lose` is told of damage (file, offset or variable), and throws where that is the end; what
/// comes after is read as far as can be. Throws InputError (file): no such file, none of MATLAB's,
/// nothing in it that is read, structs more than 16 deep; built without libmatio. Memory: 8 bytes
/// per number, and the largest variable twice.
std::vector<MatArray> read_mat_arrays(const std::filesystem::path& file,
                                      const std::function<void(const InputError&)>& lose);

}  // namespace kelpie::bag
