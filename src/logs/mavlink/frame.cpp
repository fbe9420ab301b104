// SPDX-License-Identifier: Apache-2.0
#include "mavlink/frame.hpp"

#include <algorithm>

#include "mavlink/checksum.hpp"

namespace kelpie::mavlink {

namespace {

std::uint16_t with_extra(std::uint16_t crc, unsigned extra) {
  const auto byte = static_cast<std::byte>(extra);
  return checksum(std::span(&byte, 1), crc);
}

}  // namespace

FrameState read_frame(const FrameHead& head, Frame& frame) {
  return read_frame(head, checksum(head.checked()), frame);
}

FrameState read_frame(const FrameHead& head, std::uint16_t crc, Frame& frame) {
  const Definition* const definition = find_definition(head.id());
  if (definition == nullptr || head.is_of_later_version()) {
    return FrameState::unknown;
  }
  const bool has_all = head.is_second() || head.payload_bytes() >= definition->basic_bytes;
  if (!has_all || with_extra(crc, definition->crc_extra) != head.stated_checksum()) {
    return FrameState::damaged;
  }
  frame = {.definition = definition,
           .system = head.system(),
           .component = head.component(),
           .sequence = head.sequence(),
           .version = head.is_second() ? 2 : 1,
           .is_signed = head.is_signed(),
           .payload = head.payload().first(std::min(head.payload_bytes(), definition->all_bytes)),
           .bytes = head.frame()};
  return FrameState::sound;
}

}  // namespace kelpie::mavlink
