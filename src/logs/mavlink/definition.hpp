// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "wire/scalar.hpp"

namespace kelpie::mavlink {

using wire::FieldKind;

/// A field of a message, and the place in the payload.
struct Field {
  std::string name;
  std::string unit;                   ///< "rad/s"; empty: undefined in the standard
  FieldKind kind = FieldKind::uint8;  ///< a number, or characters: the field is a text
  std::size_t count = 1;              ///< elements
  std::size_t offset = 0;             ///< bytes from the payload's start
  bool extension = false;  ///< added later: absent in MAVLink 1, and counts for no checksum
};

/// A message of MAVLink (https://mavlink.io/en/messages).
struct Definition {
  std::uint32_t id = 0;
  std::string name;             ///< "ATTITUDE"
  std::vector<Field> fields;    ///< in the order of transmission
  std::size_t basic_bytes = 0;  ///< of the payload without extensions
  std::size_t all_bytes = 0;    ///< with extensions
  std::uint8_t crc_extra = 0;   ///< of name, types and order: guards against another definition

  /// The field called `field`, or null.
  const Field* find(std::string_view field) const;
};

/// The messages of MAVLink's sets minimal, standard, common and ardupilotmega, sorted by id.
std::span<const Definition> definitions();

/// The definition with this id or name, or null.
const Definition* find_definition(std::uint32_t id);
const Definition* find_definition(std::string_view name);

/// An element of a field. Bytes beyond the payload are 0, because MAVLink 2 cuts off trailing
/// zeros. Integers beyond 2⁵³ are rounded. Requires index < field.count and a numeric field.
double number_at(const Field& field, std::span<const std::byte> payload, std::size_t index = 0);

/// The text of a field. Requires a field of characters.
std::string text_at(const Field& field, std::span<const std::byte> payload);

}  // namespace kelpie::mavlink
