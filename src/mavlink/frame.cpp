// SPDX-License-Identifier: Apache-2.0
#include "mavlink/frame.hpp"

#include <algorithm>

#include "mavlink/checksum.hpp"

namespace kelpie::mavlink {

FrameState read_frame(const FrameHead& head, Frame& frame) {
  const Definition* const definition = find_definition(head.id());
  if (definition == nullptr || head.is_of_later_version()) {
    return FrameState::unknown;
  }
  const bool is_too_short = !head.is_second() && head.payload_bytes() < definition->basic_bytes;
  const auto extra = static_cast<std::byte>(definition->crc_extra);
  if (is_too_short ||
      checksum(std::span(&extra, 1), checksum(head.checked())) != head.stated_checksum()) {
    return FrameState::damaged;
  }
  frame = {.definition = definition,
           .system = head.system(),
           .component = head.component(),
           .sequence = head.sequence(),
           .version = head.is_second() ? 2 : 1,
           .is_signed = head.is_signed(),
           .payload = head.payload().first(std::min(head.payload_bytes(), definition->all_bytes))};
  return FrameState::sound;
}

}  // namespace kelpie::mavlink
