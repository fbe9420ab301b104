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

// The times of finite values.
std::vector<double> times_with(const std::vector<double>& times_s,
                               const std::vector<double>& values) {
  std::vector<double> found;
  for (std::size_t row = 0; row < times_s.size(); ++row) {
    if (std::isfinite(times_s[row]) && std::isfinite(values[row])) {
      found.push_back(times_s[row]);
    }
  }
  return found;
}

void measure_times(const std::vector<double>& times_s, bag::BagReport& report) {
  bag::TopicReport& topic = report.topics.front();
  const std::vector<double> times = times_with(times_s, times_s);
  for (std::size_t row = 1; row < times.size(); ++row) {
    if (times[row] - times[row - 1] > topic.longest_gap_s) {
      topic.longest_gap_s = times[row] - times[row - 1];
      topic.longest_gap_at_s = times[row - 1] - times.front();
    }
  }
  topic.rate_hz = measured_rate(times);
  const auto [low, high] = std::ranges::minmax(times);
  report.duration_s = high - low;
}

}  // namespace

bag::BagReport inspect_table(const Table& table, const RowClock& clock) {
  bag::BagReport report;
  report.messages = table.rows();
  bag::TopicReport& topic = report.topics.emplace_back();
  topic.type = "a table";
  topic.messages = table.rows();
  const std::vector<double> times_s = clock.column.empty() && clock.rate_hz == 0.0
                                          ? std::vector<double>{}
                                          : row_times_s(table, clock.column, clock.rate_hz, true);
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
                            .noise = statistics.noise(),
                            .rate_hz = measured_rate(times_with(times_s, table.columns[column]))});
  }
  if (std::ranges::any_of(times_s, [](double t) { return std::isfinite(t); })) {
    measure_times(times_s, report);
  }
  return report;
}

Table read_table(const LogSource& source, const Roles& given, std::string& told) {
  const bool recovers = source.mode == bag::ReadMode::recover;
  Table table = read_csv(source.path, recovers ? &told : nullptr);
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
    const Table table = read_table(source, given, told);
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
