// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace kelpie::bag {

/// What the numbers of a column of time count.
struct StampUnit {
  std::string_view name;  ///< "ms"; "d" for days
  double seconds = 1.0;
  double zero = 0.0;  ///< the number of 1970, where the numbers count from another year; else 0

  double seconds_of(double number) const { return (number - zero) * seconds; }
};

/// The unit at the end of a name, "t_ms" or "time_usec"; empty: none.
std::optional<StampUnit> unit_in_name(std::string_view name);

/// The unit of `steps` + 1 increasing stamps by their size: ms, us or ns since 1970, as seconds
/// thousands of years ahead, or days (Excel's, MATLAB's datenum), whose steps are too short for
/// seconds. Empty: s, or a count of another beginning.
std::optional<StampUnit> unit_by_size(double first, double last, std::size_t steps);

/// "t" of "t_ms", in small letters.
std::string without_time_unit(std::string_view name);

}  // namespace kelpie::bag
