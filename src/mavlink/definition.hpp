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

/// A field of a message, and where it stands in the payload.
struct Field {
  std::string name;
  std::string unit;                   ///< "rad/s"; empty: the standard names none
  FieldKind kind = FieldKind::uint8;  ///< a number, or characters: then the field is one text
  std::size_t count = 1;              ///< elements
  std::size_t offset = 0;             ///< bytes from the payload's start
  bool extension = false;  ///< added later: absent in MAVLink 1, and counts for no checksum
};

/// A message of MAVLink (https://mavlink.io/en/messages).
struct Definition {
  std::uint32_t id = 0;
  std::string name;             ///< "ATTITUDE"
  std::vector<Field> fields;    ///< in the order they are sent in
  std::size_t basic_bytes = 0;  ///< of the payload without extensions
  std::size_t all_bytes = 0;    ///< and with them
  std::uint8_t crc_extra = 0;   ///< of name, types and order: guards against another definition

  /// The field of this name, or null.
  const Field* find(std::string_view field) const;
};

/// The messages of MAVLink's sets minimal, standard, common and ardupilotmega, by their numbers.
std::span<const Definition> definitions();

/// The definition of this number or name, or null.
const Definition* find_definition(std::uint32_t id);
const Definition* find_definition(std::string_view name);

/// An element of a field. MAVLink 2 leaves zeros at the end of a payload out, so what lies behind
/// it is 0. Whole numbers beyond 2⁵³ are rounded. Requires index < field.count and no text.
double number_at(const Field& field, std::span<const std::byte> payload, std::size_t index = 0);

/// The text of a field. Requires that its kind is characters.
std::string text_at(const Field& field, std::span<const std::byte> payload);

}  // namespace kelpie::mavlink
