// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "log/dataset.hpp"

namespace kelpie::log {

/// The times of a table's rows.
struct RowClock {
  std::string column{};   ///< of the times; "": none, or rows at `rate_hz`
  double rate_hz = 0.0;   ///< as given, for rows without times; else 0
  std::string unit{};     ///< the stamps' likely unit where they are hardly in s; "": none
  std::string problem{};  ///< why rows have no times that can be used, with the remedy; "": they do
};

/// The clock of a table to be sampled: the column that `given` names, else by any known name or by
/// time stamps; without a usable column the given rate.
RowClock row_clock(const Table& table, const Roles& given);

/// The times of the rows [s]: those of the column `time`, or without one rows at `rate_hz`. Throws
/// InputError on a missing column and, unless `with_words`, on cells that are no numbers.
std::vector<double> row_times_s(const Table& table, const std::string& time, double rate_hz,
                                bool with_words = false);

/// The rows after which a signal's autocorrelation has fallen to one half, between powers of two in
/// a straight line; all rows where the signal never forgets so much, 1 of a constant. Cost O(rows),
/// times the logarithm of the result.
double memory_rows(const std::vector<double>& values);

/// Sets the unit of the time's column where nobody gave one and its name (time_ms) or its size (ms
/// since 1970, days) leaves no other. Returns a line for the user; "" where nothing was set.
std::string settle_time_unit(Table& table, const Roles& given);

/// "time runs backwards, from 7 (line 3) to 5 s; …" with the likely cause, of the first step back
/// by more than `most_s`; "" without any. `line`: set to that of the row.
std::string time_order_problem(const Table& table, std::size_t column, double most_s,
                               std::size_t& line);

/// A column that would be a time if its cells could be read: "; when holds '01.05.2023', …"; or "".
std::string unread_time_text(const Table& table);

}  // namespace kelpie::log
