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

bool is_right_for_some(std::uint16_t crc, std::uint16_t stated) {
  for (unsigned extra = 0; extra < 256; ++extra) {
    if (with_extra(crc, extra) == stated) {
      return true;
    }
  }
  return false;
}

}  // namespace

FrameState read_frame(const FrameHead& head, Frame& frame) {
  const Definition* const definition = find_definition(head.id());
  const std::uint16_t crc = checksum(head.checked());
  const std::uint16_t stated = head.stated_checksum();
  const bool is_defined = definition != nullptr && !head.is_of_later_version() &&
                          (head.is_second() || head.payload_bytes() >= definition->basic_bytes);
  if (!is_defined || with_extra(crc, definition->crc_extra) != stated) {
    return is_right_for_some(crc, stated) ? FrameState::unknown : FrameState::damaged;
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
