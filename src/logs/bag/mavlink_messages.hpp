// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bag/decoding.hpp"
#include "mavlink/frame.hpp"

namespace kelpie::bag {

/// The encoding "mavlink": a message is the payload of a frame, the type is the message's name.
/// Throws InputError (type) on a message outside of mavlink::definitions().
MessageType mavlink_type_of(const Topic& topic, const MessageDefinitions& definitions);

/// Visits zeros cut off by MAVLink 2, too, and missing extensions as zeros.
void visit_mavlink_numbers(const MessageType& type, std::span<const std::byte> message,
                           NumberVisitor& visitor);

/// time_boot_ms or time_usec.
std::vector<StampPart> mavlink_stamp_of(const MessageType& type);

/// A sender: a part of a vehicle.
struct MavlinkSender {
  std::uint8_t system = 0;
  std::uint8_t component = 0;

  auto operator<=>(const MavlinkSender&) const = default;
};

/// Whether the frame is the HEARTBEAT of an autopilot: not of a ground station, camera or computer.
bool is_of_autopilot(const mavlink::Frame& frame);

/// The topic of a sender's messages: "ATTITUDE" of `vehicle`, "/mavlink/2/1/ATTITUDE" (system,
/// component) of everyone else.
Topic mavlink_topic(const mavlink::Definition& definition, const MavlinkSender& sender,
                    const std::optional<MavlinkSender>& vehicle);

/// The topic of messages without definition: "/mavlink/1/1/12345".
Topic unknown_mavlink_topic(std::uint32_t id, const MavlinkSender& sender);

}  // namespace kelpie::bag
