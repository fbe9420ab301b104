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

/// A leaf that is a part of the sender's stamp.
struct StampPart {
  std::size_t leaf = 0;
  std::int64_t unit_ns = 1;  ///< that its numbers count
};

/// How messages of one encoding become numbers: a line in decoding.cpp for each. docs/readers.md
/// says how the next one is added.
struct Encoding {
  std::string_view name;  ///< as in Topic::encoding
  /// The layout of a topic's messages. Throws InputError (type) when there is no definition.
  MessageType (*type_of)(const Topic& topic, const MessageDefinitions& definitions);
  /// What else a copy of the topic has to bring along, for those who don't know its type; may be
  /// empty. Throws as type_of() does.
  std::string (*definition_of)(const Topic& topic, const MessageDefinitions& definitions);
  /// Tells a message's numbers. Throws InputError (byte, field) on what is none of that type.
  void (*visit)(const MessageType& type, std::span<const std::byte> message,
                NumberVisitor& visitor);
  /// Where the type has the time at which it was sent; empty: nowhere.
  std::vector<StampPart> (*stamp_of)(const MessageType& type);
};

/// Throws InputError naming the encodings that there are.
const Encoding& encoding_called(std::string_view name);

/// The definition that a copy of the topic brings along. Throws InputError where nobody has one.
std::string definition_of(const Topic& topic, const MessageDefinitions& definitions);

/// The messages of one topic as numbers.
class Decoder {
 public:
  Decoder() = default;  ///< Of nothing: type() has no fields.
  /// Throws InputError: no definition, an unknown encoding.
  Decoder(const Topic& topic, const MessageDefinitions& definitions)
      : encoding_(&encoding_called(topic.encoding)),
        type_(encoding_->type_of(topic, definitions)),
        stamp_(encoding_->stamp_of(type_)) {}

  const MessageType& type() const { return type_; }
  const std::vector<StampPart>& stamp() const { return stamp_; }
  /// Requires a topic. Throws InputError (byte, field) on a message that isn't of its type.
  void visit(std::span<const std::byte> message, NumberVisitor& visitor) const {
    encoding_->visit(type_, message, visitor);
  }

 private:
  const Encoding* encoding_ = nullptr;
  MessageType type_;
  std::vector<StampPart> stamp_;
};

/// Decodes the message given last; what is wrong is handed to the bag with its place. Returns
/// whether the message was whole.
bool decode(MessageReader& bag, const Message& message, const Decoder& decoder,
            NumberVisitor& visitor);

/// Puts a topic's stamps together from their numbers.
class StampReader {
 public:
  StampReader() = default;
  explicit StampReader(const Decoder& decoder);

  bool exists() const { return !parts_.empty(); }
  bool wants(std::size_t leaf) const;
  /// A message's number, of any leaf. Throws InputError (field) on a time beyond
  /// Message::kLatestNs.
  void number(std::size_t leaf, double value);
  /// Of the message whose numbers were given last. Counters of 32 bits that come to their end
  /// (after 71 minutes in µs) and begin anew at 0 are counted on.
  std::int64_t time_ns() const;

 private:
  struct Part {
    StampPart part;
    std::string path;
    std::int64_t wraps_at = 0;  // 0: never
    std::int64_t value = 0;
    std::int64_t wrapped = 0;
  };
  static void count_on(Part& one, std::int64_t count);

  std::vector<Part> parts_;
};

}  // namespace kelpie::bag
