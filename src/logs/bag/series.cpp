// SPDX-License-Identifier: Apache-2.0
#include "bag/series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "bag/autopilot_state.hpp"
#include "bag/topic_columns.hpp"
#include "core/text.hpp"

namespace kelpie::bag {
namespace {

// Puts the columns of one topic together, message by message.
class SeriesBuilder {
 public:
  explicit SeriesBuilder(TopicColumns& columns) : columns_(columns) {
    series_.topic = columns.topic();
    for (const ColumnName& column : columns.columns()) {
      series_.names.push_back(column.name);
    }
    series_.values.resize(series_.names.size());
  }

  TopicColumns& columns() { return columns_; }

  void leave_out() { ++series_.disarmed; }

  void add(MessageReader& bag, const Message& message, SenderTimes& times) {
    columns_.begin(message);
    if (!decode(bag, message, columns_.decoder(), columns_) || !columns_.settle_time(times)) {
      return;
    }
    series_.times_ns.push_back(columns_.time_ns());
    for (std::size_t k = 0; k < series_.values.size(); ++k) {
      series_.values[k].push_back(columns_.values()[k]);
    }
  }

  // The series in the order of time.
  Series finished() {
    check_not_empty();
    std::vector<std::size_t> order(series_.times_ns.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return series_.times_ns[i]; });
    Series sorted{series_.topic, series_.names, {}, {}};
    sorted.stored_first_ns = series_.times_ns.front();
    sorted.disarmed = series_.disarmed;
    for (std::size_t k = 0; k < series_.names.size(); ++k) {
      sorted.units.push_back(columns_.unit(k));
    }
    for (std::size_t k = 1; k < order.size(); ++k) {
      const std::int64_t back = series_.times_ns[k - 1] - series_.times_ns[k];
      sorted.steps_back += back > 0 ? 1 : 0;
      sorted.longest_back_ns = std::max(sorted.longest_back_ns, back);
    }
    std::ranges::transform(order, std::back_inserter(sorted.times_ns),
                           [&](std::size_t i) { return series_.times_ns[i]; });
    for (const std::vector<double>& values : series_.values) {
      std::ranges::transform(order, std::back_inserter(sorted.values.emplace_back()),
                             [&](std::size_t i) { return values[i]; });
    }
    return sorted;
  }

 private:
  void check_not_empty() const {
    if (series_.times_ns.empty() && series_.disarmed > 0) {
      throw InputError(series_.topic,
                       "has no message while the autopilot says that its motors are armed; "
                       "armed_only = true in [log] leaves out the others");
    }
    if (series_.times_ns.empty()) {
      throw InputError(series_.topic, "has no readable messages");
    }
    for (std::size_t k = 0; k < series_.values.size(); ++k) {
      const ColumnName& column = columns_.columns()[k];
      const bool is_nowhere =
          std::ranges::all_of(series_.values[k], [](double value) { return std::isnan(value); });
      if (is_nowhere && !column.indices.empty()) {
        throw InputError(column.name, "no message has that element; elements count from 0");
      }
    }
  }

  TopicColumns& columns_;
  Series series_;
};

void check_all_met(const std::vector<std::unique_ptr<TopicColumns>>& wanted,
                   const MessageReader& bag) {
  std::vector<std::string> topics;
  for (const Topic& topic : bag.topics()) {
    topics.push_back(topic.name);
  }
  for (const auto& one : wanted) {
    if (!one->is_bound()) {
      throw InputError(one->topic(),
                       fmt::format("there is no such topic{}; the topics are {}",
                                   did_you_mean(one->topic(), topics), join_text(topics, ", ")));
    }
  }
}

std::vector<Series> read_named(MessageReader& bag, const MessageDefinitions& definitions,
                               std::span<const std::string> columns, Clock clock, bool armed_only,
                               std::map<std::string, double>* parameters) {
  const std::vector<std::unique_ptr<TopicColumns>> wanted = columns_by_topic(columns);
  std::vector<SeriesBuilder> builders;
  builders.reserve(wanted.size());
  SenderTimes times;
  for (const auto& one : wanted) {
    builders.emplace_back(*one);
    times.expect(one->topic());
  }
  std::vector<SeriesBuilder*> by_topic;  // nullptr: no column is of it
  const auto bind_new_topics = [&] {
    for (std::size_t k = by_topic.size(); k < bag.topics().size(); ++k) {
      const Topic& topic = bag.topics()[k];
      const auto builder = std::ranges::find_if(
          builders, [&](SeriesBuilder& there) { return there.columns().topic() == topic.name; });
      by_topic.push_back(builder == builders.end() ? nullptr : &*builder);
      if (by_topic.back() != nullptr) {
        by_topic.back()->columns().bind(topic, definitions, clock);
      }
    }
  };
  bind_new_topics();
  AutopilotState autopilot;
  for (Message message; bag.next(message);) {
    bind_new_topics();
    if (armed_only || parameters != nullptr) {
      autopilot.hear(bag.topics(), message);
    }
    SeriesBuilder* const builder = by_topic[message.topic];
    if (builder != nullptr && armed_only && autopilot.is_disarmed()) {
      builder->leave_out();
    } else if (builder != nullptr) {
      builder->add(bag, message, times);
    }
  }
  bind_new_topics();
  check_all_met(wanted, bag);
  if (parameters != nullptr) {
    *parameters = autopilot.parameters();
  }
  std::vector<Series> series;
  series.reserve(builders.size());
  for (SeriesBuilder& builder : builders) {
    series.push_back(builder.finished());
  }
  return series;
}

}  // namespace

std::size_t Series::column(const std::string& name) const {
  return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
}

const Series& series_with(std::span<const Series> all, const std::string& column) {
  return *std::ranges::find_if(
      all, [&](const Series& one) { return one.column(column) < one.names.size(); });
}

std::vector<Series> read_series(MessageReader& bag, const MessageDefinitions& definitions,
                                std::span<const std::string> columns, Clock clock, bool armed_only,
                                std::map<std::string, double>* parameters) {
  return in_file(bag.source(), [&] {
    return read_named(bag, definitions, columns, clock, armed_only, parameters);
  });
}

}  // namespace kelpie::bag
