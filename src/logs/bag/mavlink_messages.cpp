// SPDX-License-Identifier: Apache-2.0
#include "bag/mavlink_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "kelpie/core/error.hpp"

namespace kelpie::bag {
namespace {

constexpr std::size_t kLongestPayload = 255;

}  // namespace

MessageType mavlink_type_of(const Topic& topic, const MessageDefinitions& /*definitions*/) {
  const mavlink::Definition* const definition = mavlink::find_definition(topic.type);
  if (definition == nullptr) {
    throw InputError(topic.type, "is an unknown MAVLink message, or has another definition");
  }
  MessageType type;
  type.name = topic.type;
  for (const mavlink::Field& from : definition->fields) {
    add_packed_field(type, from.name, from.kind, static_cast<std::uint32_t>(from.count), from.unit);
  }
  return type;
}

void visit_mavlink_numbers(const MessageType& type, std::span<const std::byte> message,
                           NumberVisitor& visitor) {
  std::array<std::byte, kLongestPayload> whole{};
  const std::size_t bytes = std::min<std::size_t>(whole.size(), type.root.least_bytes);
  if (message.size() > bytes) {
    throw InputError(type.name,
                     fmt::format("has {} bytes; its type has {}", message.size(), bytes));
  }
  std::ranges::copy(message, whole.begin());
  visit_packed_numbers(type, std::span(whole).first(bytes), visitor);
}

std::vector<StampPart> mavlink_stamp_of(const MessageType& type) {
  constexpr std::array<std::pair<const char*, std::int64_t>, 2> kStamps{
      {{"time_boot_ms", 1'000'000}, {"time_usec", 1'000}}};
  for (const auto& [path, unit_ns] : kStamps) {
    if (const std::size_t leaf = type.find(path); leaf < type.leaves.size()) {
      return {{leaf, unit_ns}};
    }
  }
  return {};
}

bool is_of_autopilot(const mavlink::Frame& frame) {
  constexpr double kGroundStation = 6.0;  // MAV_TYPE_GCS
  constexpr double kNoAutopilot = 8.0;    // MAV_AUTOPILOT_INVALID
  if (frame.definition == nullptr || frame.definition->name != "HEARTBEAT") {
    return false;
  }
  const auto value = [&](const char* field) {
    return mavlink::number_at(*frame.definition->find(field), frame.payload);
  };
  return value("type") != kGroundStation && value("autopilot") != kNoAutopilot;
}

Topic mavlink_topic(const mavlink::Definition& definition, const MavlinkSender& sender,
                    const std::optional<MavlinkSender>& vehicle) {
  return {.name = sender == vehicle ? definition.name
                                    : fmt::format("/mavlink/{}/{}/{}", sender.system,
                                                  sender.component, definition.name),
          .type = definition.name,
          .encoding = "mavlink"};
}

Topic unknown_mavlink_topic(std::uint32_t id, const MavlinkSender& sender) {
  return {.name = fmt::format("/mavlink/{}/{}/{}", sender.system, sender.component, id),
          .type = fmt::format("message {}", id),
          .encoding = "mavlink"};
}

}  // namespace kelpie::bag
