// SPDX-License-Identifier: Apache-2.0
// libFuzzer's target for recordings: every corpus without a target of its own goes through it. Any
// bytes end in messages, numbers or an InputError. CONTRIBUTING.md has the command.

#include <cstddef>
#include <cstdint>
#include <span>

#include "bag/open_bag.hpp"
#include "fuzz/read_all.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  kelpie::fuzz::read_all(std::as_bytes(std::span(data, size)), kelpie::bag::open_bytes);
  return 0;
}
