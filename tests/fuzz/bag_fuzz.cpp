// SPDX-License-Identifier: Apache-2.0
// libFuzzer's target for bags in MCAP: whatever the bytes, reading them ends in messages, numbers
// or an InputError. CONTRIBUTING.md has the command.

#include <cstddef>
#include <cstdint>
#include <span>

#include "bag/inspect.hpp"
#include "bag/mcap_reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const kelpie::bag::MessageDefinitions definitions;
  for (const kelpie::bag::ReadMode mode :
       {kelpie::bag::ReadMode::strict, kelpie::bag::ReadMode::recover}) {
    try {
      const auto bag = kelpie::bag::read_mcap(std::as_bytes(std::span(data, size)), "fuzz", mode);
      kelpie::bag::inspect_bag(*bag, definitions);
    } catch (const kelpie::InputError&) {  // the only exception that is due
      continue;
    }
  }
  return 0;
}
