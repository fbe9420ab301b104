// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "bag/message_type.hpp"
#include "bag/reader.hpp"
#include "bag/topic_columns.hpp"

namespace kelpie::bag {

/// Columns of a topic, by message, in the order of time.
struct Series {
  std::string topic;
  std::vector<std::string> names;           ///< of the columns, as given to read_series()
  std::vector<std::int64_t> times_ns;       ///< since the clock's epoch, never decreasing
  std::vector<std::vector<double>> values;  ///< values[column][message]; NaN: no such element
  std::size_t steps_back = 0;               ///< messages stored behind a message with a later time
  std::int64_t longest_back_ns = 0;         ///< how far back the farthest step of time went
  std::int64_t stored_first_ns = 0;         ///< of the first message in storage
  std::vector<std::string> units{};         ///< of the columns, as in the definition
  std::size_t disarmed = 0;                 ///< messages left out because motors were disarmed

  /// Index of a column; names.size() if the series lacks the column.
  std::size_t column(const std::string& name) const;
};

/// The series with this column. Requires a series with the column.
const Series& series_with(std::span<const Series> all, const std::string& column);

/// Reads columns, each named by topic and path of a field: "/odom:twist.twist.linear.x" or
/// "/thrusters:velocity[2]" (elements count from 0). Returns a Series per topic, in the order of
/// the topics' first columns. Other topics are not decoded. Throws InputError (bag, column or
/// topic): malformed name, unknown topic or field (with the nearest known name), a text field, a
/// sequence that never had the element, a topic without messages, definition or known encoding, no
/// header for the header clock; damage, but in recover mode, where messages that cannot be decoded
/// are skipped and noted. `armed_only`: messages while the autopilot says that its motors are
/// disarmed are left out (AutopilotState). `parameters`, if any, is set to the autopilot's.
std::vector<Series> read_series(MessageReader& bag, const MessageDefinitions& definitions,
                                std::span<const std::string> columns, Clock clock,
                                bool armed_only = false,
                                std::map<std::string, double>* parameters = nullptr);

}  // namespace kelpie::bag
