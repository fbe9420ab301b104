// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "mavlink/checksum.hpp"
#include "mavlink/frame_parser.hpp"

namespace kelpie::testing {

using Bytes = std::vector<std::byte>;

inline Bytes bytes_of_hex(const std::string& text) {
  Bytes bytes;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2) {
    bytes.push_back(static_cast<std::byte>(std::stoul(text.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

/// A frame of MAVLink 2 as others may write it, of a message whose definition has this extra byte
/// in its checksum.
inline Bytes other_frame(std::uint32_t id, std::uint8_t extra, std::uint8_t sequence = 0,
                         unsigned flags = 0) {
  const auto byte = [](unsigned value) { return static_cast<std::byte>(value & 0xFFU); };
  Bytes frame{byte(0xFD), byte(4), byte(flags), byte(0),        byte(sequence),
              byte(1),    byte(1), byte(id),    byte(id >> 8U), byte(id >> 16U),
              byte(1),    byte(2), byte(3),     byte(4)};
  const std::byte last = byte(extra);
  const std::uint16_t crc =
      mavlink::checksum(std::span(&last, 1), mavlink::checksum(std::span(frame).subspan(1)));
  frame.push_back(byte(crc));
  frame.push_back(byte(static_cast<unsigned>(crc) >> 8U));
  return frame;
}

/// A number of a frame's message. Requires a field of this name.
inline double number_of(const mavlink::Frame& frame, const std::string& field,
                        std::size_t index = 0) {
  return mavlink::number_at(*frame.definition->find(field), frame.payload, index);
}

inline std::string text_of(const mavlink::Frame& frame, const std::string& field) {
  return mavlink::text_at(*frame.definition->find(field), frame.payload);
}

}  // namespace kelpie::testing
