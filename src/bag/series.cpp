// SPDX-License-Identifier: Apache-2.0
#include "bag/series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "bag/column.hpp"
#include "bag/decoding.hpp"
#include "kelpie/core/text.hpp"

namespace kelpie::bag {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// Puts the columns of one topic together, message by message.
class SeriesBuilder final : public NumberVisitor {
 public:
  explicit SeriesBuilder(const std::string& topic) { series_.topic = topic; }

  const std::string& topic() const { return series_.topic; }
  void ask(const ColumnName& column) {
    series_.names.push_back(column.name);
    columns_.push_back(column);
  }

  // Once the topic is met in the bag. Throws InputError about the columns.
  void bind(const Topic& topic, const MessageDefinitions& definitions, Clock clock) {
    try {
      type_ = cdr_type_of(topic, definitions);
    } catch (const InputError& error) {
      throw InputError(topic.name, error.what());
    }
    wanted_.assign(type_.leaves.size(), false);
    for (const ColumnName& column : columns_) {
      leaves_.push_back(leaf_of(column, type_));
      wanted_[leaves_.back()] = true;
    }
    if (clock == Clock::header) {
      stamp_ = StampReader(type_);
      if (!stamp_.exists()) {
        throw InputError(topic.name,
                         fmt::format("{} has no header, so its messages have only the times at "
                                     "which they were received: take the clock 'receive'",
                                     topic.type));
      }
    }
    series_.values.resize(columns_.size());
    row_.resize(columns_.size());
    is_bound_ = true;
  }
  bool is_bound() const { return is_bound_; }

  void add(BagReader& bag, const Message& message) {
    std::ranges::fill(row_, kNone);
    if (!decode(bag, message, type_, *this)) {
      return;
    }
    series_.times_ns.push_back(stamp_.exists() ? stamp_.time_ns() : message.receive_ns);
    for (std::size_t k = 0; k < row_.size(); ++k) {
      series_.values[k].push_back(row_[k]);
    }
  }

  bool wants(std::size_t leaf) const override { return wanted_[leaf] || stamp_.wants(leaf); }
  void number(std::size_t leaf, std::span<const std::uint32_t> indices, double value) override {
    stamp_.number(leaf, value);
    for (std::size_t k = 0; k < leaves_.size(); ++k) {
      if (leaves_[k] == leaf && std::ranges::equal(columns_[k].indices, indices)) {
        row_[k] = value;
      }
    }
  }

  // The series in the order of time.
  Series finished() {
    check_not_empty();
    std::vector<std::size_t> order(series_.times_ns.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return series_.times_ns[i]; });
    Series sorted{series_.topic, series_.names, {}, {}};
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
    if (series_.times_ns.empty()) {
      throw InputError(series_.topic, "has no messages that can be read");
    }
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      const bool is_nowhere =
          std::ranges::all_of(series_.values[k], [](double value) { return std::isnan(value); });
      if (is_nowhere && !columns_[k].indices.empty()) {
        throw InputError(columns_[k].name, "no message has that element; elements count from 0");
      }
    }
  }

  Series series_;
  std::vector<ColumnName> columns_;
  std::vector<std::size_t> leaves_;
  MessageType type_;
  std::vector<bool> wanted_;
  StampReader stamp_;
  std::vector<double> row_;
  bool is_bound_ = false;
};

std::vector<std::unique_ptr<SeriesBuilder>> builders_of(std::span<const std::string> columns) {
  std::vector<std::unique_ptr<SeriesBuilder>> builders;
  for (const std::string& name : columns) {
    const ColumnName column = parse_column(name);
    auto builder = std::ranges::find_if(
        builders, [&](const auto& there) { return there->topic() == column.topic; });
    if (builder == builders.end()) {
      builders.push_back(std::make_unique<SeriesBuilder>(column.topic));
      builder = builders.end() - 1;
    }
    (*builder)->ask(column);
  }
  return builders;
}

void check_all_met(const std::vector<std::unique_ptr<SeriesBuilder>>& builders,
                   const BagReader& bag) {
  std::vector<std::string> topics;
  for (const Topic& topic : bag.topics()) {
    topics.push_back(topic.name);
  }
  for (const auto& builder : builders) {
    if (!builder->is_bound()) {
      throw InputError(builder->topic(), fmt::format("there is no such topic{}; the topics are {}",
                                                     did_you_mean(builder->topic(), topics),
                                                     join_text(topics, ", ")));
    }
  }
}

std::vector<Series> read_named(BagReader& bag, const MessageDefinitions& definitions,
                               std::span<const std::string> columns, Clock clock) {
  const std::vector<std::unique_ptr<SeriesBuilder>> builders = builders_of(columns);
  std::vector<SeriesBuilder*> by_topic;  // nullptr: no column is of it
  const auto bind_new_topics = [&] {
    for (std::size_t k = by_topic.size(); k < bag.topics().size(); ++k) {
      const Topic& topic = bag.topics()[k];
      const auto builder = std::ranges::find_if(
          builders, [&](const auto& there) { return there->topic() == topic.name; });
      by_topic.push_back(builder == builders.end() ? nullptr : builder->get());
      if (by_topic.back() != nullptr) {
        by_topic.back()->bind(topic, definitions, clock);
      }
    }
  };
  bind_new_topics();
  for (Message message; bag.next(message);) {
    bind_new_topics();
    if (by_topic[message.topic] != nullptr) {
      by_topic[message.topic]->add(bag, message);
    }
  }
  bind_new_topics();
  check_all_met(builders, bag);
  std::vector<Series> series;
  series.reserve(builders.size());
  for (const auto& builder : builders) {
    series.push_back(builder->finished());
  }
  return series;
}

}  // namespace

std::vector<Series> read_series(BagReader& bag, const MessageDefinitions& definitions,
                                std::span<const std::string> columns, Clock clock) {
  try {
    return read_named(bag, definitions, columns, clock);
  } catch (const InputError& error) {
    if (!error.place().file.empty()) {
      throw;
    }
    throw InputError({.file = bag.source(), .line = 0, .field = {}}, error.what());
  }
}

}  // namespace kelpie::bag
