// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "bag/message_type.hpp"

namespace kelpie::bag {

/// Receives the numbers of a message in the order of storage.
class NumberVisitor {
 public:
  NumberVisitor() = default;
  virtual ~NumberVisitor() = default;
  NumberVisitor(const NumberVisitor&) = delete;
  NumberVisitor& operator=(const NumberVisitor&) = delete;

  /// Whether the numbers of a leaf (an index in MessageType::leaves) are wanted. Arrays of unwanted
  /// numbers are skipped in a single step.
  virtual bool wants(std::size_t leaf) const = 0;

  /// Receives a number; `indices` has an index per enclosing array or sequence, the outermost
  /// first. Integers beyond 2⁵³ are rounded; false and true are 0 and 1.
  virtual void number(std::size_t leaf, std::span<const std::uint32_t> indices, double value) = 0;
};

/// Reads a message of the given type in plain CDR (OMG CDR with the four bytes of encapsulation;
/// both byte orders). Cost: linear in the message; allocates only the indices. Throws InputError
/// naming byte and field: another encoding, a message shorter than the type, a sequence or string
/// longer than the bound or the remaining bytes, eight or more bytes left over (wrong definition).
/// The visitor has then received the numbers before the damage.
void visit_numbers(const MessageType& type, std::span<const std::byte> message,
                   NumberVisitor& visitor);

/// Reads a message of packed little-endian fields, without encapsulation, alignment and padding, as
/// in most formats besides CDR. Otherwise as visit_numbers().
void visit_packed_numbers(const MessageType& type, std::span<const std::byte> message,
                          NumberVisitor& visitor);

}  // namespace kelpie::bag
