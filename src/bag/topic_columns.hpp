// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bag/cdr.hpp"
#include "bag/decoding.hpp"
#include "bag/message_type.hpp"
#include "bag/reader.hpp"

namespace kelpie::bag {

/// A column's name taken apart: "/a:b[2].c" has the topic "/a", the pattern "b[].c" and the
/// indices {2}.
struct ColumnName {
  std::string name;
  std::string topic;
  std::string pattern;
  std::vector<std::uint32_t> indices{};
};

/// Throws InputError (column) when `name` isn't one.
ColumnName parse_column(const std::string& name);

/// The leaf that the column means in its topic's type. Throws InputError (column), with the nearest
/// field, when there is none, and when it is text or no single element.
std::size_t leaf_of(const ColumnName& column, const MessageType& type);

/// Whose clock the times of messages are taken from.
enum class Clock {
  receive,  ///< the recorder's, when the message arrived
  header,   ///< the sender's: header.stamp; of MAVLink time_boot_ms or time_usec,
            ///< of DataFlash TimeUS, of ULog timestamp
};

/// The columns that are wanted of one topic, taken out of its messages, one after the other:
///
///     columns.begin(message);
///     columns.decoder().visit(message.data, columns);    // or decode()
///
/// then values() and time_ns() are the message's. Allocates nothing per message but what
/// decoding does.
class TopicColumns final : public NumberVisitor {
 public:
  explicit TopicColumns(std::string topic) : topic_(std::move(topic)) {}

  /// One more column, of this topic.
  void ask(const ColumnName& column);

  /// Once the topic's type is known. Throws InputError (column or topic): no definition, an
  /// encoding that isn't known, no such field, a field of text, no header for that clock.
  void bind(const Topic& topic, const MessageDefinitions& definitions, Clock clock);

  const std::string& topic() const { return topic_; }
  const std::vector<ColumnName>& columns() const { return columns_; }
  bool is_bound() const { return is_bound_; }
  /// Of a column, as its definition has it; empty: it has none. Requires is_bound().
  const std::string& unit(std::size_t column) const {
    return decoder_.type().leaves[leaves_[column]].unit;
  }
  const Decoder& decoder() const { return decoder_; }  ///< Requires is_bound(), as all below.

  void begin(const Message& message);
  std::span<const double> values() const { return values_; }  ///< one per column; NaN: none
  std::int64_t time_ns() const { return stamp_.exists() ? stamp_.time_ns() : receive_ns_; }

  bool wants(std::size_t leaf) const override { return wanted_[leaf] || stamp_.wants(leaf); }
  void number(std::size_t leaf, std::span<const std::uint32_t> indices, double value) override;

 private:
  std::string topic_;
  std::vector<ColumnName> columns_;
  std::vector<std::size_t> leaves_;
  Decoder decoder_;
  std::vector<bool> wanted_;
  StampReader stamp_;
  std::int64_t receive_ns_ = 0;
  std::vector<double> values_;
  bool is_bound_ = false;
};

/// One per topic that the columns name, in the order in which they name them first. Throws
/// InputError (column) on a name that isn't one.
std::vector<std::unique_ptr<TopicColumns>> columns_by_topic(std::span<const std::string> columns);

}  // namespace kelpie::bag
