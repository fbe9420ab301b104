// SPDX-License-Identifier: Apache-2.0
#include "bag/topic_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::bag {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

void check_array_sizes(const ColumnName& column, const Field& structure, std::size_t level,
                       std::string_view rest) {
  const std::size_t dot = std::min(rest.find('.'), rest.size());
  const std::string_view name = rest.substr(0, std::min(rest.find('['), dot));
  const auto field = std::ranges::find(structure.fields, name, &Field::name);
  const bool is_many = field->shape != FieldShape::single;
  if (is_many && column.indices[level] >= field->size) {
    throw InputError(column.name,
                     fmt::format("{} has {}{} elements, counted from 0", name,
                                 field->shape == FieldShape::array ? "" : "at most ", field->size));
  }
  if (dot < rest.size()) {
    check_array_sizes(column, *field, level + (is_many ? 1 : 0), rest.substr(dot + 1));
  }
}

}  // namespace

ColumnName parse_column(const std::string& name) {
  const std::size_t colon = name.find(':');
  if (colon == 0 || colon == std::string::npos || colon + 1 == name.size()) {
    throw InputError(name, "is no column of a bag; one reads as /odom:twist.twist.linear.x");
  }
  ColumnName column{.name = name, .topic = name.substr(0, colon), .pattern = ""};
  for (std::size_t at = colon + 1; at < name.size();) {
    column.pattern += name[at];
    if (name[at++] != '[') {
      continue;
    }
    std::uint32_t index = 0;
    const char* const end = name.data() + name.size();
    const auto [stop, error] = std::from_chars(name.data() + at, end, index);
    if (error != std::errc{} || stop == end || *stop != ']') {
      throw InputError(name, "between [ and ] a whole number from 0 on is due, as in velocity[2]");
    }
    column.indices.push_back(index);
    at = static_cast<std::size_t>(stop - name.data());
  }
  return column;
}

std::size_t leaf_of(const ColumnName& column, const MessageType& type) {
  const std::size_t leaf = type.find(column.pattern);
  if (leaf == type.leaves.size()) {
    std::vector<std::string> paths;
    for (const MessageType::Leaf& there : type.leaves) {
      if (there.path == column.pattern + "[]") {
        throw InputError(column.name,
                         "is an array; name one of its elements, as in " + column.name + "[0]");
      }
      if (is_number(there.kind)) {
        paths.push_back(there.path);
      }
    }
    throw InputError(column.name,
                     fmt::format("{} has no field {}{}; `kelpie inspect` lists its fields",
                                 type.name, column.pattern, did_you_mean(column.pattern, paths)));
  }
  if (!is_number(type.leaves[leaf].kind)) {
    throw InputError(column.name, "is text; columns are numbers");
  }
  check_array_sizes(column, type.root, 0, column.pattern);
  return leaf;
}

void TopicColumns::ask(const ColumnName& column) {
  columns_.push_back(column);
}

void TopicColumns::bind(const Topic& topic, const MessageDefinitions& definitions, Clock clock) {
  try {
    decoder_ = Decoder(topic, definitions);
  } catch (const InputError& error) {
    throw InputError(topic.name, error.what());
  }
  bound_.clear();
  wanted_.assign(decoder_.type().leaves.size(), false);
  for (const ColumnName& column : columns_) {
    bound_.push_back(bound(column));
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

bool TopicColumns::Element::is(std::size_t other, std::span<const std::uint32_t> at) const {
  return leaf == other && std::ranges::equal(indices, at);
}

TopicColumns::Element TopicColumns::element_of(const ColumnName& column) {
  Element element{.leaf = leaf_of(column, decoder_.type()), .indices = column.indices};
  wanted_[element.leaf] = true;
  return element;
}

TopicColumns::BoundColumn TopicColumns::bound(const ColumnName& column) {
  const auto unit = [this](const Element& element) {
    return decoder_.type().leaves[element.leaf].unit;
  };
  BoundColumn result;
  const std::size_t slash = column.name.find('/', column.topic.size() + 1);
  const MessageType& type = decoder_.type();
  if (slash == std::string::npos || type.find(column.pattern) < type.leaves.size()) {
    result.field = element_of(column);
    result.unit = unit(result.field);
    return result;
  }
  result.field = element_of(parse_column(column.name.substr(0, slash)));
  result.divisor = element_of(parse_column(column.topic + ":" + column.name.substr(slash + 1)));
  if (const std::string over = unit(*result.divisor); !unit(result.field).empty()) {
    result.unit = unit(result.field) + (over.empty() ? "" : "/" + over);
  }
  return result;
}

void TopicColumns::begin(const Message& message) {
  receive_ns_ = message.receive_ns;
  std::ranges::fill(values_, kMissing);
  for (BoundColumn& column : bound_) {
    column.field.value = kMissing;
    if (column.divisor) {
      column.divisor->value = kMissing;
    }
  }
}

void TopicColumns::number(std::size_t leaf, std::span<const std::uint32_t> indices, double value) {
  stamp_.number(leaf, value);
  for (std::size_t k = 0; k < bound_.size(); ++k) {
    BoundColumn& column = bound_[k];
    const bool is_field = column.field.is(leaf, indices);
    if (!column.divisor) {
      values_[k] = is_field ? value : values_[k];
      continue;
    }
    const bool is_divisor = column.divisor->is(leaf, indices);
    column.field.value = is_field ? value : column.field.value;
    column.divisor->value = is_divisor ? value : column.divisor->value;
    if (is_field || is_divisor) {
      const double quotient = column.field.value / column.divisor->value;
      values_[k] = std::isfinite(quotient) ? quotient : kMissing;
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
