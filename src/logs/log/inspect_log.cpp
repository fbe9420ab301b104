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
#include "log/draft_plan.hpp"

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

std::string time_field(const Table& table) {
  std::string found;
  std::size_t best = std::numeric_limits<std::size_t>::max();
  const auto try_name = [&](std::size_t column, const std::string& name, const auto& names,
                            std::size_t first) {
    const auto place = std::ranges::find(names, name) - std::ranges::begin(names);
    const std::size_t rank = first + static_cast<std::size_t>(place);
    if (static_cast<std::size_t>(place) < std::ranges::size(names) && rank < best) {
      best = rank;
      found = table.names[column];
    }
  };
  const std::size_t words = kTimeNames.size();
  const std::size_t others = 2 * words;
  const std::size_t stamps = others + known_times().size();
  for (std::size_t column = 0; column < table.names.size(); ++column) {
    if (table.is_of_words(column)) {
      continue;
    }
    try_name(column, table.names[column], kTimeNames, 0);
    const std::string name = join_text(words_of(table.names[column]), "_");
    try_name(column, name, kTimeNames, words);
    try_name(column, name, known_times(), others);
    if (table.is_time(column) && stamps < best) {
      best = stamps;
      found = table.names[column];
    }
  }
  return found;
}

bag::BagReport inspect_table(const Table& table) {
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
  if (const std::string name = time_field(table); !name.empty()) {
    const std::size_t time = table.find(name);
    const double unit_s = table.seconds_per_unit(time);
    measure_times(table.columns[time], unit_s, topic);
    const auto field = std::ranges::find(topic.fields, name, &bag::FieldRange::path);
    report.duration_s = field->finite > 0 ? unit_s * (field->high - field->low) : 0.0;
  }
  return report;
}

InspectedLog inspect_log(const LogSource& source) {
  if (!bag::is_bag(source.path)) {
    Table table = read_csv(source.path);
    std::string missing = set_missing_pulses(table);
    return {.report = inspect_table(table), .draft = draft_of(table), .losses = std::move(missing)};
  }
  const bag::MessageDefinitions definitions(source.definitions);
  const std::unique_ptr<bag::MessageReader> bag = source.open_bag();
  InspectedLog found{.report = bag::inspect_bag(*bag, definitions), .draft = {}};
  found.losses = bag->losses_text();
  found.draft = draft_of(found.report, source);
  return found;
}

}  // namespace kelpie::log
