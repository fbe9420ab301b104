// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bag/cdr.hpp"
#include "bag/message_type.hpp"
#include "bag/reader.hpp"

namespace kelpie::bag {

/// A leaf that holds a part of the sender's time stamp.
struct StampPart {
  std::size_t leaf = 0;
  std::int64_t unit_ns = 1;  ///< unit of the leaf's numbers
};

/// Conversion of messages to numbers: a line of kEncodings in decoding.cpp per encoding.
/// src/logs/bag/README.md explains how to add an encoding.
struct Encoding {
  std::string_view name;  ///< as in Topic::encoding
  /// The layout of a topic's messages. Throws InputError (type) without a definition.
  MessageType (*type_of)(const Topic& topic, const MessageDefinitions& definitions);
  /// The definition for a copy of the topic, for programs without knowledge of the type; may be
  /// empty. Throws as type_of() does.
  std::string (*definition_of)(const Topic& topic, const MessageDefinitions& definitions);
  /// Visits the numbers of a message. Throws InputError (byte, field) on a message of another type.
  void (*visit)(const MessageType& type, std::span<const std::byte> message,
                NumberVisitor& visitor);
  /// The leaves with the time of sending; empty: not recorded.
  std::vector<StampPart> (*stamp_of)(const MessageType& type);
};

/// Throws InputError naming the known encodings.
const Encoding& encoding_called(std::string_view name);

/// The definition for a copy of the topic. Throws InputError for a type without definition.
std::string definition_of(const Topic& topic, const MessageDefinitions& definitions);

/// Converts the messages of a topic to numbers.
class Decoder {
 public:
  Decoder() = default;  ///< Without topic: type() has no fields.
  /// Throws InputError: no definition, an unknown encoding.
  Decoder(const Topic& topic, const MessageDefinitions& definitions)
      : encoding_(&encoding_called(topic.encoding)),
        type_(encoding_->type_of(topic, definitions)),
        stamp_(encoding_->stamp_of(type_)) {}

  const MessageType& type() const { return type_; }
  const std::vector<StampPart>& stamp() const { return stamp_; }
  /// Requires a topic. Throws InputError (byte, field) on a message of another type.
  void visit(std::span<const std::byte> message, NumberVisitor& visitor) const {
    encoding_->visit(type_, message, visitor);
  }

 private:
  const Encoding* encoding_ = nullptr;
  MessageType type_;
  std::vector<StampPart> stamp_;
};

/// Decodes the last message of `bag`, and reports damage with the place of the message. Returns
/// whether the message was whole.
bool decode(MessageReader& bag, const Message& message, const Decoder& decoder,
            NumberVisitor& visitor);

/// Composes the time stamps of a topic from numbers.
class StampReader {
 public:
  StampReader() = default;
  explicit StampReader(const Decoder& decoder);

  bool exists() const { return !parts_.empty(); }
  bool wants(std::size_t leaf) const;
  /// A message's number, of any leaf. Throws InputError (field) on a time beyond
  /// Message::kLatestNs.
  void number(std::size_t leaf, double value);
  /// Stamp of the last message, with the overflows of the last place().
  std::int64_t time_ns() const;
  /// Whether the stamp is a counter of 32 bits, which overflows: after 49.7 days in ms, and
  bool wraps() const;
  bool wraps_soon() const;  ///< … after 71.6 minutes in µs.
  /// Adds overflows to the last stamp, so that the stamp is nearest to `near_ns`. Requires wraps().
  void place(std::int64_t near_ns);

 private:
  struct Part {
    StampPart part;
    std::string path;
    std::int64_t wraps_at = 0;  // 0: never
    std::int64_t value = 0;
    std::int64_t wrapped = 0;
  };

  std::vector<Part> parts_;
};

}  // namespace kelpie::bag
