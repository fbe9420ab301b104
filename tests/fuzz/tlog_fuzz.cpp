// SPDX-License-Identifier: Apache-2.0
// libFuzzer's target for .tlog files and for the payloads in them: whatever the bytes, reading them
// ends in messages, numbers or an InputError. CONTRIBUTING.md has the command.

#include <cstddef>
#include <cstdint>
#include <span>

#include "bag/byte_reader.hpp"
#include "bag/decoding.hpp"
#include "bag/tlog_reader.hpp"
#include "fuzz/read_all.hpp"
#include "mavlink/definition.hpp"

namespace {

class Nobody final : public kelpie::bag::NumberVisitor {
 public:
  bool wants(std::size_t /*leaf*/) const override { return true; }
  void number(std::size_t /*leaf*/, std::span<const std::uint32_t> /*indices*/,
              double /*value*/) override {}
};

// As the payload of some message: no fuzzer gets the checksum of a frame right.
void decode(std::span<const std::byte> bytes) {
  const auto definitions = kelpie::mavlink::definitions();
  const std::size_t number =
      static_cast<std::size_t>(bytes[0]) << 8U | static_cast<std::size_t>(bytes[1]);
  const kelpie::bag::Decoder decoder(
      {.name = "x", .type = definitions[number % definitions.size()].name, .encoding = "mavlink"},
      kelpie::bag::MessageDefinitions());
  Nobody nobody;
  decoder.visit(bytes.subspan(2), nobody);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::byte> bytes = std::as_bytes(std::span(data, size));
  kelpie::bag::begins_as_tlog(kelpie::bag::text_of(bytes));
  kelpie::fuzz::read_all(bytes, [](auto content, const char* name, auto mode) {
    return kelpie::bag::read_tlog(content, name, mode);
  });
  if (size > 2) {
    try {
      decode(bytes);
    } catch (const kelpie::InputError&) {  // too many bytes
      return 0;
    }
  }
  return 0;
}
