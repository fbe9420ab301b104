// SPDX-License-Identifier: Apache-2.0
#include "ros/text_message.hpp"

#include <cstdint>

namespace kelpie::ros {

std::optional<std::string> text_of(std::span<const std::byte> cdr) {
  constexpr std::size_t kBegin = 8;  // behind encapsulation and length
  if (cdr.size() < kBegin || cdr[0] != std::byte{0} || cdr[1] > std::byte{1}) {
    return std::nullopt;
  }
  const bool is_little = cdr[1] == std::byte{1};
  std::uint32_t length = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto shift = 8 * (is_little ? i : 3 - i);
    length |= std::to_integer<std::uint32_t>(cdr[4 + i]) << shift;
  }
  // The length includes the terminating zero.
  if (length == 0 || length > cdr.size() - kBegin) {
    return std::nullopt;
  }
  std::string text;
  for (const std::byte byte : cdr.subspan(kBegin, length - 1)) {
    text += static_cast<char>(byte);
  }
  return text;
}

}  // namespace kelpie::ros
