// SPDX-License-Identifier: Apache-2.0
#include "live/row_reader.hpp"

#include <fmt/format.h>

#include <optional>
#include <span>
#include <string_view>
#include <utility>

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

}  // namespace

RowReader::RowReader(std::shared_ptr<const log::Dataset> rows, std::shared_ptr<FurtherRows> further)
    : MessageReader(bag::ReadMode::usual, rows->source),
      rows_(std::move(rows)),
      further_(std::move(further)),
      first_s_(rows_->times_s.front()),
      fields_(fields_of(*rows_)),
      builder_(bag::MessageDefinitions().type(kType, definition_of(fields_))) {
  add_topic({.name = kTopic, .type = kType, .definition = definition_of(fields_)}, source());
}

Place RowReader::place() const {
  return {.file = source(), .line = 0, .field = fmt::format("row {}", count_)};
}

bool RowReader::step(bag::Message& message) {
  std::size_t field = 0;
  for (const std::span<const double> values : {rows_->input(next_), rows_->target(next_)}) {
    for (const double value : values) {
      builder_.set(fields_[field++], value);
    }
  }
  const std::int64_t time_ns = nanoseconds(rows_->times_s[next_] - first_s_);
  message = {.topic = 0,
             .receive_ns = time_ns,
             .publish_ns = time_ns,
             .sequence = count_,
             .data = builder_.bytes()};
  ++count_;
  if (++next_ == rows_->rows() && further_) {
    if (std::optional<log::Dataset> next = further_->next()) {
      rows_ = std::make_shared<const log::Dataset>(std::move(*next));
      next_ = 0;
    }
  }
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

log::Reach RowReader::reach_of(const log::Dataset& rows, const FurtherRows* further) {
  const double end_s = further == nullptr ? rows.times_s.back() : further->end_s;
  return {.origin_ns = 0, .end_s = seconds(nanoseconds(end_s - rows.times_s.front()))};
}

}  // namespace kelpie::live
