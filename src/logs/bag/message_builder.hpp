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

/// Composes messages of a type as plain CDR, little-endian, as visit_numbers() reads. Paths read
/// "header.stamp.sec" or "status[0].values[2].key"; a sequence grows to hold the index. Unset
/// fields are zero or empty, as in ROS 2. Values stay set for the next message.
class MessageBuilder {
 public:
  explicit MessageBuilder(MessageType type);  ///< A message of zeros.

  /// Sets a number. Throws InputError (path) on an unknown or non-numeric field, or on a `value`
  /// outside of the integer's range.
  void set(std::string_view path, double value);
  /// Sets a text. Throws InputError (path) as above, or on a text longer than the bound.
  void set(std::string_view path, std::string_view text);
  /// Sets an array or sequence of numbers, also the length ("covariance", "data"). Throws
  /// InputError (path) as above, or on a length outside of the bound.
  void set(std::string_view path, std::span<const double> values);
  /// Sets the length of a sequence; new elements are zero or empty. Throws InputError (path).
  void resize(std::string_view path, std::size_t length);

  /// The message, with the four bytes of encapsulation; valid until the next call.
  std::span<const std::byte> bytes();

 private:
  /// Value of a field: parts of a structure, elements of an array or sequence, a number, or a text.
  struct Value {
    double number = 0.0;
    std::string text{};
    std::vector<Value> parts{};
  };
  /// A value and its field; for an element the field of the array, with `element` set.
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
