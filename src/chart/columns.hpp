// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace kelpie::chart {

/// Columns of numbers in few bytes of a page, as figure.js unpacks them (docs/charts.md): each
/// value is rounded to one of 65,535 steps between the column's least and greatest, or 2³² − 1;
/// what changes from one to the next is compressed. What isn't finite stays that.
class Columns {
 public:
  /// The number of the column. One that is there already is not kept twice.
  std::size_t add(std::vector<double> values, bool fine = false);

  nlohmann::json description() const;  ///< Length, range and bytes per value of each.
  std::string base64() const;          ///< All of them, compressed.

 private:
  struct Column {
    std::vector<double> values;
    double low = 0.0;  ///< of the finite ones
    double high = 0.0;
    std::size_t width = 2;  ///< bytes
  };
  std::vector<Column> columns_;
};

}  // namespace kelpie::chart
