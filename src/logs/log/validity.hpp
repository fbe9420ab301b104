// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "log/dataset.hpp"

namespace kelpie::log {

/// Sets cells to NaN that are no measurement: cells that equal a number of Roles::missing
/// ("-999", "u=0"), and velocities in rows
///
/// - where a column says so: velocity_valid, bottom_lock, … (0 and 1, or words as True and False),
///   a figure of merit (fom) beyond 0.4 m/s;
/// - of a mark far beyond all others (-32.768, -999), or a farthest value that comes again;
/// - of exact zeros in all velocities that begin or end with a jump;
/// - of one number, to the last bit, while other velocities change (frozen_rows()).
///
/// "none" among Roles::missing leaves the velocities alone. Returns lines for the user, with
/// counts. Throws InputError (file) where no row has a velocity left, and on text that is no
/// number.
std::string drop_missing(Table& table, const Roles& given);

/// Places of a signal's values that stand for none, in order.
using Rows = std::vector<std::size_t>;

/// Values equal to a number that Roles::missing has for a signal of one of these names. Throws
/// InputError (--missing) on text without a number.
Rows missing_rows(std::span<const double> values, const Roles& given,
                  std::initializer_list<std::string_view> names);

/// Values of a velocity that are a sensor's mark of none, or the farthest value where the value
/// comes again, three times as far out as all others; none where Roles::missing has "none".
Rows mark_rows(std::span<const double> values, const Roles& given);

/// Exact zeros in all velocities of one sensor that begin and end with a jump; likewise.
Rows zero_rows(const std::vector<std::span<const double>>& velocities, const Roles& given);

/// Rows of a frozen sensor: the number of velocity `frozen` repeats for 20 rows or more, four times
/// as long as ever outside of freezes, while another of the velocities changes, and ends with a
/// jump or the log; likewise. Zeros are not among them.
Rows frozen_rows(const std::vector<std::span<const double>>& velocities, std::size_t frozen,
                 const Roles& given);

/// Sets these values to NaN.
void drop_rows(const Rows& rows, std::vector<double>& values);

}  // namespace kelpie::log
