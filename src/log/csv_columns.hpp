// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "log/dataset.hpp"

namespace kelpie::log {

/// Takes the names of a table's columns from its header: "u [m/s]" or "u (m/s)" is the column u
/// with that unit, where no other column is called so. The first column may lack a name until
/// finish_columns(). Throws InputError (file, line, column) on names that are missing, used twice,
/// not UTF-8, or all numbers.
void name_columns(Table& table, std::span<const std::string_view> cells, std::size_t line);

/// Takes the row below the header as units and returns true, if it is one: no numbers, each cell a
/// unit, "-" or empty, and one of them known.
bool take_units(Table& table, std::span<const std::string_view> cells);

/// Once all rows are read: columns of time stamps (parse_stamp) become s since their first one; a
/// first column without a name is dropped where it numbers the rows, as pandas writes it, and
/// called "time" where it holds stamps. Throws InputError (file, line, column) where it is neither.
void finish_columns(Table& table, std::size_t header_line);

}  // namespace kelpie::log
