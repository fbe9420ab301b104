// SPDX-License-Identifier: Apache-2.0
#include "file/crc32.hpp"

#include <zlib.h>

namespace kelpie::file {

std::uint32_t crc32_of(std::span<const std::byte> bytes, std::uint32_t before) {
  const auto* const data = reinterpret_cast<const Bytef*>(bytes.data());  // NOLINT: zlib's bytes
  // Without data zlib gives 0, whatever came before.
  return bytes.empty() ? before : static_cast<std::uint32_t>(::crc32_z(before, data, bytes.size()));
}

}  // namespace kelpie::file
