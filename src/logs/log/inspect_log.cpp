// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "bag/open_bag.hpp"
#include "bag/statistics.hpp"
#include "core/text.hpp"
#include "log/candidates.hpp"
#include "log/dataset.hpp"
#include "log/draft.hpp"
#include "log/validity.hpp"

namespace kelpie::log {
namespace {

void measure_times(const std::vector<double>& times, double unit_s, bag::TopicReport& topic) {
  double first = std::numeric_limits<double>::infinity();
  double last = -first;
  std::size_t rows = 0;
  for (const double time : times) {
    const double t = unit_s * time;
    if (!std::isfinite(t)) {
      continue;
    }
    if (rows > 0 && t - last > topic.longest_gap_s) {
      topic.longest_gap_s = t - last;
      topic.longest_gap_at_s = last - first;
    }
    first = rows == 0 ? t : first;
    last = t;
    ++rows;
  }
  topic.rate_hz = last > first ? static_cast<double>(rows - 1) / (last - first) : 0.0;
}

}  // namespace

bag::BagReport inspect_table(const Table& table, const RowClock& clock) {
  bag::BagReport report;
  report.messages = table.rows();
  bag::TopicReport& topic = report.topics.emplace_back();
  topic.type = "a table";
  topic.messages = table.rows();
  for (std::size_t column = 0; column < table.names.size(); ++column) {
    if (table.is_of_words(column)) {
      continue;
    }
    bag::Statistics statistics;
    for (const double value : table.columns[column]) {
      statistics.add(value);
    }
    topic.fields.push_back({.path = table.names[column],
                            .low = statistics.low(),
                            .high = statistics.high(),
                            .finite = statistics.finite(),
                            .not_finite = statistics.not_finite(),
                            .unit = column < table.units.size() ? table.units[column] : "",
                            .noise = statistics.noise()});
  }
  if (clock.rate_hz > 0.0 && clock.column.empty()) {
    topic.rate_hz = clock.rate_hz;
    report.duration_s = static_cast<double>(table.rows() - 1) / clock.rate_hz;
  } else if (!clock.column.empty()) {
    const std::size_t time = table.find(clock.column);
    const double unit_s = table.seconds_per_unit(time);
    measure_times(table.columns[time], unit_s, topic);
    const auto field = std::ranges::find(topic.fields, clock.column, &bag::FieldRange::path);
    report.duration_s = field->finite > 0 ? unit_s * (field->high - field->low) : 0.0;
  }
  return report;
}

Table read_table(const std::filesystem::path& file, const Roles& given, std::string& told) {
  Table table = read_csv(file);
  told += drop_missing(table, given);
  told += set_missing_pulses(table);
  told += settle_time_unit(table, given);
  const std::string time = row_clock(table, given).column;
  table.units.resize(table.names.size());
  for (const auto& [name, text] : given.units) {
    if (const auto found = std::ranges::find(table.names, name); found != table.names.end()) {
      table.units[static_cast<std::size_t>(found - table.names.begin())] =
          name == time ? text : std::string();
    }
  }
  return table;
}

InspectedLog inspect_log(const LogSource& source, const Roles& given) {
  if (!bag::is_bag(source.path)) {
    std::string told;
    const Table table = read_table(source.path, given, told);
    return {.report = inspect_table(table, row_clock(table, given)),
            .draft = draft_of(table, given),
            .losses = std::move(told)};
  }
  const bag::MessageDefinitions definitions(source.definitions);
  const std::unique_ptr<bag::MessageReader> bag = source.open_bag();
  InspectedLog found{.report = bag::inspect_bag(*bag, definitions), .draft = {}};
  found.losses = bag->losses_text();
  found.draft = draft_of(found.report, source);
  return found;
}

}  // namespace kelpie::log
