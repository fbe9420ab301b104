// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace kelpie {

/// FNV-1a of a text's bytes, or of a text that goes on from one of this hash: published and stable,
/// where std::hash may differ between standard libraries.
constexpr std::uint64_t fnv1a(std::string_view text, std::uint64_t hash = 0xcbf2'9ce4'8422'2325) {
  for (const char letter : text) {
    hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100'0000'01b3;
  }
  return hash;
}

}  // namespace kelpie
