// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bag/message_type.hpp"

namespace kelpie::bag {

/// Puts messages of a type together as plain CDR, little-endian, as visit_numbers() reads it.
/// Paths read "header.stamp.sec" or "status[0].values[2].key"; a sequence grows to hold the index.
/// What isn't set is zero or empty, as in ROS 2. Everything stays set from one message to the next.
class MessageBuilder {
 public:
  explicit MessageBuilder(MessageType type);  ///< A message of zeros.

  /// A number. Throws InputError (path) where the type has no such field, or it is no number or an
  /// integer that can't hold `value`.
  void set(std::string_view path, double value);
  /// A text. Throws InputError (path) as above, or where it is longer than the type allows.
  void set(std::string_view path, std::string_view text);
  /// All of an array or sequence of numbers, which gets this length ("covariance", "data").
  /// Throws InputError (path) as above, or where the length isn't one the type allows.
  void set(std::string_view path, std::span<const double> values);
  /// The length of a sequence; elements that are new are zero or empty. Throws InputError (path).
  void resize(std::string_view path, std::size_t length);

  /// The message, with the four bytes of its encapsulation; valid until the next call.
  std::span<const std::byte> bytes();

 private:
  /// A field's value: the parts of a structure, the elements of an array or sequence, or one number
  /// or text.
  struct Value {
    double number = 0.0;
    std::string text{};
    std::vector<Value> parts{};
  };
  /// A value and its field; of an element the field of the whole, with `element` set.
  struct Target {
    const Field* field;
    Value* value;
    bool element;
  };

  static Value zero_of(const Field& field, bool element);
  Target find(std::string_view path);
  static void grow(std::string_view path, Target& whole, std::size_t length);
  void write(const Field& field, const Value& value, bool element);
  void write_number(FieldKind kind, double value);
  void write_length(std::size_t length);

  MessageType type_;
  Value root_;
  std::vector<std::byte> bytes_;
};

}  // namespace kelpie::bag
