// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "bag/message_type.hpp"

namespace kelpie::bag {

/// Hears the numbers of a message in the order they are stored in.
class NumberVisitor {
 public:
  NumberVisitor() = default;
  virtual ~NumberVisitor() = default;
  NumberVisitor(const NumberVisitor&) = delete;
  NumberVisitor(NumberVisitor&&) = delete;
  NumberVisitor& operator=(const NumberVisitor&) = delete;
  NumberVisitor& operator=(NumberVisitor&&) = delete;

  /// Whether the numbers of this leaf (an index in MessageType::leaves) are to be told. What isn't
  /// wanted is passed over in one step where it stands in an array.
  virtual bool wants(std::size_t leaf) const = 0;

  /// One number; `indices` has one index per array or sequence around it, the outermost first.
  /// Whole numbers beyond 2⁵³ are rounded; false and true are 0 and 1.
  virtual void number(std::size_t leaf, std::span<const std::uint32_t> indices, double value) = 0;
};

/// Walks through a message in plain CDR (OMG CDR with the four bytes of its encapsulation; both
/// byte orders) of the given type. Cost: linear in the message; allocates nothing but the indices.
/// Throws InputError naming byte and field: another encoding, a message that ends before its type
/// does, a sequence or string longer than its bound or than what is left, eight or more bytes left
/// over (the definition isn't that of the message). Numbers before the damage have been told.
void visit_numbers(const MessageType& type, std::span<const std::byte> message,
                   NumberVisitor& visitor);

/// The same of fields that stand one right behind the other, little-endian, with nothing before,
/// between or behind them, as most other formats have them.
void visit_packed_numbers(const MessageType& type, std::span<const std::byte> message,
                          NumberVisitor& visitor);

}  // namespace kelpie::bag
