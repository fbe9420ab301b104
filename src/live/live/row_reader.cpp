// SPDX-License-Identifier: Apache-2.0
#include "live/row_reader.hpp"

#include <fmt/format.h>

#include <span>
#include <string_view>

#include "bag/message_text.hpp"
#include "bag/message_type.hpp"
#include "core/seconds.hpp"

namespace kelpie::live {
namespace {

constexpr const char* kType = "kelpie/msg/Rows";

std::vector<std::string> columns_of(const log::Dataset& rows) {
  std::vector<std::string> columns = rows.input_names;
  columns.insert(columns.end(), rows.target_names.begin(), rows.target_names.end());
  return columns;
}

// A column of a table may have any name; a field may not.
std::string field_name(const std::string& column, std::size_t place) {
  constexpr std::string_view kNumbered = "column_";
  return bag::is_identifier(column) && !column.starts_with(kNumbered)
             ? column
             : fmt::format("{}{}", kNumbered, place);
}

std::vector<std::string> fields_of(const log::Dataset& rows) {
  std::vector<std::string> fields = columns_of(rows);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    fields[i] = field_name(fields[i], i);
  }
  return fields;
}

std::string definition_of(const std::vector<std::string>& fields) {
  std::string text;
  for (const std::string& field : fields) {
    text += "float64 " + field + "\n";
  }
  return text;
}

// Since the first row.
std::int64_t stamp_ns(const log::Dataset& rows, std::size_t row) {
  return nanoseconds(rows.times_s[row] - rows.times_s.front());
}

}  // namespace

RowReader::RowReader(const log::Dataset& rows)
    : MessageReader(bag::ReadMode::usual, rows.source),
      rows_(rows),
      fields_(fields_of(rows)),
      builder_(bag::MessageDefinitions().type(kType, definition_of(fields_))) {
  add_topic({.name = kTopic, .type = kType, .definition = definition_of(fields_)}, rows.source);
}

Place RowReader::place() const {
  return {.file = source(), .line = 0, .field = fmt::format("row {}", next_)};
}

bool RowReader::step(bag::Message& message) {
  std::size_t field = 0;
  for (const std::span<const double> values : {rows_.input(next_), rows_.target(next_)}) {
    for (const double value : values) {
      builder_.set(fields_[field++], value);
    }
  }
  const std::int64_t time_ns = stamp_ns(rows_, next_);
  message = {.topic = 0,
             .receive_ns = time_ns,
             .publish_ns = time_ns,
             .sequence = static_cast<std::uint32_t>(next_),
             .data = builder_.bytes()};
  ++next_;
  return true;
}

// Lines for commands, too: a row between two samples by a rounded stamp then hardly differs.
std::vector<StreamPlan::Source> RowReader::sources_of(const log::Dataset& rows) {
  std::vector<StreamPlan::Source> sources;
  const std::vector<std::string> columns = columns_of(rows);
  const std::vector<std::string> fields = fields_of(rows);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    sources.push_back({.name = columns[i], .from = std::string(kTopic) + ":" + fields[i]});
  }
  return sources;
}

log::Reach RowReader::reach_of(const log::Dataset& rows) {
  return {.origin_ns = 0, .end_s = seconds(stamp_ns(rows, rows.rows() - 1))};
}

}  // namespace kelpie::live
