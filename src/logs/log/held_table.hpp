// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "bag/series.hpp"
#include "log/dataset.hpp"

namespace kelpie::log {

/// Makes a table with a row per message of the first series: t [s] from the first row, then
/// `columns` in the given order. Columns of later series hold the latest value not after the row;
/// NaN before the first value. Messages call the table `source`.
Table held_table(std::span<const bag::Series> series, std::span<const std::string> columns,
                 const std::string& source);

}  // namespace kelpie::log
