// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "bag/series.hpp"
#include "log/dataset.hpp"

namespace kelpie::log {

/// One row per message of the first series; columns t [s] from the first row, then `columns` as
/// they were asked for. A column of another series holds what its last message not after the row
/// had; NaN until there is one. `source` is what messages call the table.
Table held_table(std::span<const bag::Series> series, std::span<const std::string> columns,
                 const std::string& source);

}  // namespace kelpie::log
