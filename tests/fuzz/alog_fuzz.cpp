// SPDX-License-Identifier: Apache-2.0
// libFuzzer's target for .alog files of MOOS: whatever the bytes, reading them ends in messages,
// numbers or an InputError. CONTRIBUTING.md has the command.

#include <cstddef>
#include <cstdint>
#include <span>

#include "bag/alog_reader.hpp"
#include "bag/byte_reader.hpp"
#include "fuzz/read_all.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::byte> bytes = std::as_bytes(std::span(data, size));
  kelpie::bag::begins_as_alog(kelpie::bag::text_of(bytes));
  kelpie::fuzz::read_all(bytes, [](auto content, const char* name, auto mode) {
    return kelpie::bag::read_alog(content, name, mode);
  });
  return 0;
}
