// SPDX-License-Identifier: Apache-2.0
#include "bag/topic_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "kelpie/core/error.hpp"

namespace kelpie::bag {

void TopicColumns::ask(const ColumnName& column) {
  columns_.push_back(column);
}

void TopicColumns::bind(const Topic& topic, const MessageDefinitions& definitions, Clock clock) {
  try {
    decoder_ = Decoder(topic, definitions);
  } catch (const InputError& error) {
    throw InputError(topic.name, error.what());
  }
  leaves_.clear();
  wanted_.assign(decoder_.type().leaves.size(), false);
  for (const ColumnName& column : columns_) {
    leaves_.push_back(leaf_of(column, decoder_.type()));
    wanted_[leaves_.back()] = true;
  }
  if (clock == Clock::header) {
    stamp_ = StampReader(decoder_);
    if (!stamp_.exists()) {
      throw InputError(topic.name,
                       fmt::format("{} has no header, so its messages have only the times at "
                                   "which they were received: take the clock 'receive'",
                                   topic.type));
    }
  }
  values_.resize(columns_.size());
  is_bound_ = true;
}

void TopicColumns::begin(const Message& message) {
  receive_ns_ = message.receive_ns;
  std::ranges::fill(values_, std::numeric_limits<double>::quiet_NaN());
}

void TopicColumns::number(std::size_t leaf, std::span<const std::uint32_t> indices, double value) {
  stamp_.number(leaf, value);
  for (std::size_t k = 0; k < leaves_.size(); ++k) {
    if (leaves_[k] == leaf && std::ranges::equal(columns_[k].indices, indices)) {
      values_[k] = value;
    }
  }
}

std::vector<std::unique_ptr<TopicColumns>> columns_by_topic(std::span<const std::string> columns) {
  std::vector<std::unique_ptr<TopicColumns>> topics;
  for (const std::string& name : columns) {
    const ColumnName column = parse_column(name);
    auto topic = std::ranges::find_if(
        topics, [&](const auto& there) { return there->topic() == column.topic; });
    if (topic == topics.end()) {
      topics.push_back(std::make_unique<TopicColumns>(column.topic));
      topic = topics.end() - 1;
    }
    (*topic)->ask(column);
  }
  return topics;
}

}  // namespace kelpie::bag
