// SPDX-License-Identifier: Apache-2.0
#include "mavlink/definition.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>

#include "kelpie/core/text.hpp"
#include "mavlink/checksum.hpp"

namespace kelpie::mavlink {
namespace {

struct Kind {
  std::string_view word;
  FieldKind kind;
  std::size_t bytes;
};

constexpr std::array<Kind, 10> kKinds{{
    {"int8_t", FieldKind::int8, 1},
    {"uint8_t", FieldKind::uint8, 1},
    {"int16_t", FieldKind::int16, 2},
    {"uint16_t", FieldKind::uint16, 2},
    {"int32_t", FieldKind::int32, 4},
    {"uint32_t", FieldKind::uint32, 4},
    {"int64_t", FieldKind::int64, 8},
    {"uint64_t", FieldKind::uint64, 8},
    {"float", FieldKind::float32, 4},
    {"char", FieldKind::text, 1},
}};

const Kind& kind_of(FieldKind kind) {
  return *std::ranges::find(kKinds, kind, &Kind::kind);
}

struct Source {
  std::uint32_t id;
  std::string_view name;
  std::string_view fields;  // as MAVLink's XML has them, extensions behind a bar
};

constexpr std::array<Source, 11> kSources{{
    {0, "HEARTBEAT",
     "uint8_t type, uint8_t autopilot, uint8_t base_mode, uint32_t custom_mode, "
     "uint8_t system_status, uint8_t mavlink_version"},
    {2, "SYSTEM_TIME", "uint64_t time_unix_usec, uint32_t time_boot_ms"},
    {30, "ATTITUDE",
     "uint32_t time_boot_ms, float roll, float pitch, float yaw, float rollspeed, "
     "float pitchspeed, float yawspeed"},
    {32, "LOCAL_POSITION_NED",
     "uint32_t time_boot_ms, float x, float y, float z, float vx, float vy, float vz"},
    {36, "SERVO_OUTPUT_RAW",
     "uint32_t time_usec, uint8_t port, uint16_t servo1_raw, uint16_t servo2_raw, "
     "uint16_t servo3_raw, uint16_t servo4_raw, uint16_t servo5_raw, uint16_t servo6_raw, "
     "uint16_t servo7_raw, uint16_t servo8_raw | uint16_t servo9_raw, uint16_t servo10_raw, "
     "uint16_t servo11_raw, uint16_t servo12_raw, uint16_t servo13_raw, uint16_t servo14_raw, "
     "uint16_t servo15_raw, uint16_t servo16_raw"},
    {76, "COMMAND_LONG",
     "uint8_t target_system, uint8_t target_component, uint16_t command, uint8_t confirmation, "
     "float param1, float param2, float param3, float param4, float param5, float param6, "
     "float param7"},
    {77, "COMMAND_ACK",
     "uint16_t command, uint8_t result | uint8_t progress, int32_t result_param2, "
     "uint8_t target_system, uint8_t target_component"},
    {251, "NAMED_VALUE_FLOAT", "uint32_t time_boot_ms, char[10] name, float value"},
    {253, "STATUSTEXT", "uint8_t severity, char[50] text | uint16_t id, uint8_t chunk_seq"},
    {331, "ODOMETRY",
     "uint64_t time_usec, uint8_t frame_id, uint8_t child_frame_id, float x, float y, float z, "
     "float[4] q, float vx, float vy, float vz, float rollspeed, float pitchspeed, "
     "float yawspeed, float[21] pose_covariance, float[21] velocity_covariance | "
     "uint8_t reset_counter, uint8_t estimator_type, int8_t quality"},
    {375, "ACTUATOR_OUTPUT_STATUS", "uint64_t time_usec, uint32_t active, float[32] actuator"},
}};

// "float[4] q"
Field field_of(const std::string& text, bool extension) {
  const std::size_t space = text.find(' ');
  const std::string_view type = std::string_view(text).substr(0, space);
  const std::string_view word = type.substr(0, type.find('['));
  Field field;
  field.name = text.substr(space + 1);
  field.extension = extension;
  field.kind = std::ranges::find(kKinds, word, &Kind::word)->kind;
  if (word.size() < type.size()) {
    std::from_chars(type.data() + word.size() + 1, type.data() + type.size(), field.count);
  }
  return field;
}

std::span<const std::byte> as_bytes(std::string_view text) {
  return std::as_bytes(std::span(text));
}

// Of the basic fields in the order they are sent in, folded to a byte.
std::uint8_t crc_extra_of(const Definition& definition) {
  std::uint16_t crc = checksum(as_bytes(definition.name + " "));
  for (const Field& field : definition.fields) {
    if (!field.extension) {
      crc = checksum(as_bytes(std::string(kind_of(field.kind).word) + " " + field.name + " "), crc);
      if (field.count > 1) {
        const auto count = static_cast<std::byte>(field.count);
        crc = checksum(std::span(&count, 1), crc);
      }
    }
  }
  return static_cast<std::uint8_t>((crc & 0xFFU) ^ (crc >> 8U));
}

Definition definition_of(const Source& source) {
  Definition definition;
  definition.id = source.id;
  definition.name = source.name;
  bool extension = false;
  for (const std::string& part : split_text(source.fields, '|')) {
    const std::size_t first = definition.fields.size();
    for (const std::string& field : split_text(part, ',')) {
      definition.fields.push_back(field_of(field, extension));
    }
    if (!extension) {  // the largest elements are sent first; extensions stay as they are
      std::stable_sort(definition.fields.begin() + static_cast<std::ptrdiff_t>(first),
                       definition.fields.end(), [](const Field& a, const Field& b) {
                         return kind_of(a.kind).bytes > kind_of(b.kind).bytes;
                       });
    }
    for (std::size_t i = first; i < definition.fields.size(); ++i) {
      Field& field = definition.fields[i];
      field.offset = definition.all_bytes;
      definition.all_bytes += field.count * kind_of(field.kind).bytes;
    }
    definition.basic_bytes = extension ? definition.basic_bytes : definition.all_bytes;
    extension = true;
  }
  definition.crc_extra = crc_extra_of(definition);
  return definition;
}

// Little-endian; what was left out is zero.
template <typename T>
T value_at(std::span<const std::byte> payload, std::size_t offset) {
  std::array<std::byte, sizeof(T)> raw{};
  if (offset < payload.size()) {
    std::ranges::copy(payload.subspan(offset, std::min(sizeof(T), payload.size() - offset)),
                      raw.begin());
  }
  if constexpr (std::endian::native == std::endian::big) {
    std::ranges::reverse(raw);
  }
  return std::bit_cast<T>(raw);
}

}  // namespace

const Field* Definition::find(std::string_view field) const {
  const auto found = std::ranges::find(fields, field, &Field::name);
  return found == fields.end() ? nullptr : &*found;
}

std::span<const Definition> definitions() {
  static const std::vector<Definition> all = [] {
    std::vector<Definition> made;
    std::ranges::transform(kSources, std::back_inserter(made), definition_of);
    return made;
  }();
  return all;
}

const Definition* find_definition(std::uint32_t id) {
  const auto found = std::ranges::find(definitions(), id, &Definition::id);
  return found == definitions().end() ? nullptr : &*found;
}

const Definition* find_definition(std::string_view name) {
  const auto found = std::ranges::find(definitions(), name, &Definition::name);
  return found == definitions().end() ? nullptr : &*found;
}

double number_at(const Field& field, std::span<const std::byte> payload, std::size_t index) {
  const std::size_t offset = field.offset + index * kind_of(field.kind).bytes;
  switch (field.kind) {
    case FieldKind::int8:
      return value_at<std::int8_t>(payload, offset);
    case FieldKind::int16:
      return value_at<std::int16_t>(payload, offset);
    case FieldKind::uint16:
      return value_at<std::uint16_t>(payload, offset);
    case FieldKind::int32:
      return value_at<std::int32_t>(payload, offset);
    case FieldKind::uint32:
      return value_at<std::uint32_t>(payload, offset);
    case FieldKind::int64:
      return static_cast<double>(value_at<std::int64_t>(payload, offset));
    case FieldKind::uint64:
      return static_cast<double>(value_at<std::uint64_t>(payload, offset));
    case FieldKind::float32:
      return static_cast<double>(value_at<float>(payload, offset));
    default:
      return value_at<std::uint8_t>(payload, offset);
  }
}

std::string text_at(const Field& field, std::span<const std::byte> payload) {
  std::string text;
  for (std::size_t i = 0; i < field.count; ++i) {
    const char letter = value_at<char>(payload, field.offset + i);
    if (letter == '\0') {
      break;
    }
    text += letter;
  }
  return text;
}

}  // namespace kelpie::mavlink
