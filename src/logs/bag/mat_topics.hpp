// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bag/mat_arrays.hpp"
#include "bag/reader.hpp"

namespace kelpie::bag {

/// Arrays with common times: a topic with a message per row.
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

  std::string name;                    ///< "workspace", or name of the struct: "log.imu"
  bool has_time = false;               ///< or rows are counted
  std::vector<std::int64_t> times_ns;  ///< per row; kNoTime where the file's is no time
  std::vector<Column> columns;
  std::string definition;  ///< as a .msg text

  static constexpr std::int64_t kNoTime = -1;
};

/// Groups arrays into topics; `arrays` has to outlive the result. A vector of times is called t,
/// time, stamp, tout or similar, with or without a unit (t_ms), and never decreases. To a vector of
/// times belong the arrays with as many rows, or else columns, in the same struct or in inner
/// structs without times. The remaining arrays form topics by struct and length, with counted rows;
/// parameters (no rows of numbers) are left out. Times are in s unless the name has another unit,
/// or the values can only be ms, µs or ns since 1970, or days as in datenum. With a negative time
/// in the file, times count from the first. Throws InputError (name) if no vector is called
/// `times.time`.
std::vector<MatTopic> mat_topics(const std::vector<MatArray>& arrays, const RowTimes& times);

}  // namespace kelpie::bag
