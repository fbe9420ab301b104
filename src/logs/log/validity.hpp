// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
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
/// - of exact zeros in all velocities that begin or end with a jump.
///
/// "none" among Roles::missing leaves the velocities alone. Returns lines for the user, with
/// counts. Throws InputError (file) where no row has a velocity left, and on text that is no
/// number.
std::string drop_missing(Table& table, const Roles& given);

/// The value that stands for none in a signal: a sensor's mark, or the farthest value where the
/// value comes again, three times as far out as all others; empty: none.
std::optional<double> mark_of_none(std::span<const double> values);

/// A text of Roles::missing: "-999", "u=0". Throws InputError (--missing) on text without a number.
struct MissingValue {
  std::string column;  ///< "": any
  double value = 0.0;
};
std::vector<MissingValue> missing_values(const Roles& given);

}  // namespace kelpie::log
