// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "bag/inspect.hpp"

namespace kelpie::fuzz {

/// Reads bytes to their end by read(bytes, name, mode), strictly and as far as can be: that ends in
/// messages, numbers or an InputError, the only exception that is due.
template <typename Read>
void read_all(std::span<const std::byte> bytes, const Read& read) {
  const bag::MessageDefinitions definitions;
  for (const bag::ReadMode mode : {bag::ReadMode::strict, bag::ReadMode::recover}) {
    try {
      const auto bag = read(bytes, "fuzz", mode);
      bag::inspect_bag(*bag, definitions);
    } catch (const InputError&) {
      continue;
    }
  }
}

}  // namespace kelpie::fuzz
