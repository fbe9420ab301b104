// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bag/cdr.hpp"
#include "bag/decoding.hpp"
#include "bag/message_type.hpp"
#include "bag/reader.hpp"
#include "bag/sender_times.hpp"

namespace kelpie::bag {

/// A column's name taken apart: "/a:b[2].c" has the topic "/a", the pattern "b[].c" and the
/// indices {2}. Where the type has no field of that name, "/a:b[2]/c" is the quotient of two fields
/// of a message, such as a way over its time.
struct ColumnName {
  std::string name;
  std::string topic;
  std::string pattern;
  std::vector<std::uint32_t> indices{};
};

/// Throws InputError (column) on a malformed name.
ColumnName parse_column(const std::string& name);

/// The leaf of a column in the topic's type. Throws InputError (column) on an unknown field (with
/// the nearest name), a text, and an array without index.
std::size_t leaf_of(const ColumnName& column, const MessageType& type);

/// The clock of message times.
enum class Clock {
  receive,  ///< the recorder's, when the message arrived
  header,   ///< the sender's: header.stamp; of MAVLink time_boot_ms or time_usec,
            ///< of DataFlash TimeUS, of ULog timestamp
};

/// Selected columns of a topic, read from consecutive messages:
///
///     columns.begin(message);
///     columns.decoder().visit(message.data, columns);    // or decode()
///
/// Then values() and time_ns() belong to the message. Allocates per message only in the decoder.
class TopicColumns final : public NumberVisitor {
 public:
  explicit TopicColumns(std::string topic) : topic_(std::move(topic)) {}

  /// Adds a column of the topic.
  void ask(const ColumnName& column);

  /// Binds the columns to the topic's type. Throws InputError (column or topic): no definition,
  /// unknown encoding, unknown field, a text field, no header for the header clock.
  void bind(const Topic& topic, const MessageDefinitions& definitions, Clock clock);

  const std::string& topic() const { return topic_; }
  const std::vector<ColumnName>& columns() const { return columns_; }
  bool is_bound() const { return is_bound_; }
  /// Unit of a column from the definition; empty: undefined. Requires is_bound().
  const std::string& unit(std::size_t column) const { return bound_[column].unit; }
  const Decoder& decoder() const {
    return decoder_;
  }  ///< Requires is_bound(), as the members below.

  void begin(const Message& message);
  std::span<const double> values() const {
    return values_;
  }  ///< a value per column; NaN: not in the message
  /// Compares the message's time with other messages of its sender, before time_ns(); whether the
  /// message may be used.
  bool settle_time(SenderTimes& times) { return times.settle(topic_, receive_ns_, stamp_); }
  std::int64_t time_ns() const { return stamp_.exists() ? stamp_.time_ns() : receive_ns_; }

  bool wants(std::size_t leaf) const override { return wanted_[leaf] || stamp_.wants(leaf); }
  void number(std::size_t leaf, std::span<const std::uint32_t> indices, double value) override;

 private:
  struct Element {
    std::size_t leaf = 0;
    std::vector<std::uint32_t> indices{};
    double value = 0.0;  // of the present message

    bool is(std::size_t other, std::span<const std::uint32_t> at) const;
  };
  struct BoundColumn {
    Element field{};
    std::optional<Element> divisor{};
    std::string unit{};
  };

  Element element_of(const ColumnName& column);
  BoundColumn bound(const ColumnName& column);

  std::string topic_;
  std::vector<ColumnName> columns_;
  std::vector<BoundColumn> bound_;
  Decoder decoder_;
  std::vector<bool> wanted_;
  StampReader stamp_;
  std::int64_t receive_ns_ = 0;
  std::vector<double> values_;
  bool is_bound_ = false;
};

/// Groups columns by topic, in the order of the topics' first columns. Throws InputError (column)
/// on a malformed name.
std::vector<std::unique_ptr<TopicColumns>> columns_by_topic(std::span<const std::string> columns);

}  // namespace kelpie::bag
