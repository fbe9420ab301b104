// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bag/message_type.hpp"
#include "bag/reader.hpp"
#include "bag/topic_columns.hpp"

namespace kelpie::bag {

/// Columns of one topic, message by message, in the order of time.
struct Series {
  std::string topic;
  std::vector<std::string> names;           ///< of the columns, as they were asked for
  std::vector<std::int64_t> times_ns;       ///< since the clock's epoch, never decreasing
  std::vector<std::vector<double>> values;  ///< values[column][message]; NaN: no such element
  std::size_t steps_back = 0;               ///< messages stored behind one with a later time
  std::int64_t longest_back_ns = 0;         ///< how far back the farthest step of time went
  std::int64_t stored_first_ns = 0;         ///< of the message that was stored first
  std::vector<std::string> units{};         ///< of the columns, as in the definition

  /// Index of a column. Requires that the series has the column.
  std::size_t column(const std::string& name) const;
};

/// The series with this column. Requires that one of `all` has the column.
const Series& series_with(std::span<const Series> all, const std::string& column);

/// Reads columns, each named by topic and path of a field, as "/odom:twist.twist.linear.x" or
/// "/thrusters:velocity[2]" (elements count from 0). One Series per topic, in the order in which
/// the columns name them first. Of topics that no column names nothing is decoded.
/// Throws InputError (bag, column or topic): a name that isn't one, an unknown topic or field
/// with the nearest that exists, a field of text, a sequence that never had the element, a topic
/// without messages, without definition, not in CDR, or without header for that clock; in strict
/// mode damage. Recover mode: a message that cannot be decoded is left out and noted.
std::vector<Series> read_series(MessageReader& bag, const MessageDefinitions& definitions,
                                std::span<const std::string> columns, Clock clock);

}  // namespace kelpie::bag
