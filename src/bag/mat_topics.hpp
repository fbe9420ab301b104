// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bag/mat_arrays.hpp"
#include "bag/reader.hpp"

namespace kelpie::bag {

/// Arrays that have the same times: a topic whose messages are their rows.
struct MatTopic {
  /// An array with a number or several for each row.
  struct Column {
    const MatArray* array = nullptr;
    bool is_across = false;  ///< rows of the topic are columns of the array

    std::size_t width() const { return is_across ? array->rows : array->columns; }
    double value(std::size_t row, std::size_t part) const {
      const std::size_t at = is_across ? row * array->rows + part : part * array->rows + row;
      return array->values[at];
    }
  };

  std::string name;                    ///< "workspace", or that of the struct: "log.imu"
  bool has_time = false;               ///< or rows are counted
  std::vector<std::int64_t> times_ns;  ///< per row; kNoTime where the file's is no time
  std::vector<Column> columns;
  std::string definition;  ///< as a .msg text

  static constexpr std::int64_t kNoTime = -1;
};

/// Finds out which arrays belong together; `arrays` has to outlive the result. A vector of times is
/// one called t, time, stamp, tout and the like, with or without a unit behind it (t_ms), whose
/// values never fall. To it belong the arrays that have as many rows, or else columns, in the same
/// struct, or within it and without a time of their own. The rest are topics by struct and length,
/// whose rows are counted; what is no row of numbers (parameters) is left out.
/// Times are in s unless the name has another unit, or they can only be ms, µs or ns since 1970, or
/// days as datenum gives them. Where one is below 0, all count from the first.
/// Throws InputError (name) where `times.time` is none of the vectors.
std::vector<MatTopic> mat_topics(const std::vector<MatArray>& arrays, const RowTimes& times);

}  // namespace kelpie::bag
