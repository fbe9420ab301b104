// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace kelpie::chart {

/// Compact columns of numbers for figure.js (src/tools/chart/README.md): each value is rounded to
/// one of 65,535 steps (`fine`: 2³² − 1) between least and greatest of the column, and the
/// differences are compressed. Values that aren't finite are kept.
class Columns {
 public:
  /// The index of the column. Equal columns are stored once.
  std::size_t add(std::vector<double> values, bool fine = false);

  nlohmann::json description() const;  ///< Length, range and bytes per value of each.
  std::string base64() const;          ///< Every column, compressed.

 private:
  struct Column {
    std::vector<double> values;
    double low = 0.0;  ///< of finite values
    double high = 0.0;
    std::size_t width = 2;  ///< bytes
  };
  std::vector<Column> columns_;
};

}  // namespace kelpie::chart
