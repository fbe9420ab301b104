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

/// The encoding "mavlink": a message is the payload of a frame, its type the message's name.
/// Throws InputError (type) on a message that mavlink::definitions() doesn't have.
MessageType mavlink_type_of(const Topic& topic, const MessageDefinitions& definitions);

/// Zeros that MAVLink 2 left out at the end are told, as are the extensions that a frame hasn't.
void visit_mavlink_numbers(const MessageType& type, std::span<const std::byte> message,
                           NumberVisitor& visitor);

/// time_boot_ms or time_usec.
std::vector<StampPart> mavlink_stamp_of(const MessageType& type);

/// A part of a vehicle that sends messages.
struct MavlinkSender {
  std::uint8_t system = 0;
  std::uint8_t component = 0;

  auto operator<=>(const MavlinkSender&) const = default;
};

/// Whether this is the HEARTBEAT of an autopilot: not of a ground station, camera or computer.
bool is_of_autopilot(const mavlink::Frame& frame);

/// The topic of a sender's messages: "ATTITUDE" of `vehicle`, "/mavlink/2/1/ATTITUDE" (system,
/// component) of everyone else.
Topic mavlink_topic(const mavlink::Definition& definition, const MavlinkSender& sender,
                    const std::optional<MavlinkSender>& vehicle);

/// That of messages of this number which nobody can decode: "/mavlink/1/1/12345".
Topic unknown_mavlink_topic(std::uint32_t id, const MavlinkSender& sender);

}  // namespace kelpie::bag
