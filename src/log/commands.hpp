// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "log/dataset.hpp"

namespace kelpie::log {

/// Inputs to be followed, not learned: a Dataset without targets. Of the roles, `inputs`, `time`
/// (guessed where neither it nor a rate is given) and `rate_hz` count. An input in `constants` is
/// that number in every row and needs no column. A row may be like the one before; none is skipped.
/// Throws InputError (file, line, column) on a missing column, a cell that is no finite number,
/// time that doesn't increase, no time, fewer than two rows.
Dataset make_commands(const Table& table, const Roles& roles,
                      const std::map<std::string, double>& constants);

}  // namespace kelpie::log
