// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kelpie::mavlink {

/// What an element of a field is.
enum class FieldKind : std::uint8_t {
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  text,  ///< char: the field is one text, ended by a zero or its length
};

/// A field of a message, and where it stands in the payload.
struct Field {
  std::string name;
  FieldKind kind = FieldKind::uint8;
  std::size_t count = 1;   ///< elements
  std::size_t offset = 0;  ///< bytes from the payload's start
  bool extension = false;  ///< added later: absent in MAVLink 1, and counts for no checksum
};

/// A message of MAVLink's common set (https://mavlink.io/en/messages/common.html).
struct Definition {
  std::uint32_t id = 0;
  std::string name;  ///< "ATTITUDE"
  std::vector<Field> fields;
  std::size_t basic_bytes = 0;  ///< of the payload without extensions
  std::size_t all_bytes = 0;    ///< and with them
  std::uint8_t crc_extra = 0;   ///< of name, types and order: guards against another definition

  /// The field of this name, or null.
  const Field* find(std::string_view field) const;
};

/// The messages that a vehicle's learner needs: HEARTBEAT, SYSTEM_TIME, ATTITUDE,
/// LOCAL_POSITION_NED, SERVO_OUTPUT_RAW, COMMAND_LONG, COMMAND_ACK, NAMED_VALUE_FLOAT, STATUSTEXT,
/// ODOMETRY and ACTUATOR_OUTPUT_STATUS.
std::span<const Definition> definitions();

/// The definition of this number or name, or null.
const Definition* find_definition(std::uint32_t id);
const Definition* find_definition(std::string_view name);

/// An element of a field. MAVLink 2 leaves zeros at the end of a payload out, so what lies behind
/// it is 0. Whole numbers beyond 2⁵³ are rounded. Requires index < field.count and no text.
double number_at(const Field& field, std::span<const std::byte> payload, std::size_t index = 0);

/// The text of a field. Requires that its kind is text.
std::string text_at(const Field& field, std::span<const std::byte> payload);

}  // namespace kelpie::mavlink
