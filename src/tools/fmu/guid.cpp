// SPDX-License-Identifier: Apache-2.0
#include "fmu/guid.hpp"

#include <array>
#include <cstdio>
#include <span>

#include "file/crc32.hpp"

namespace kelpie::fmu {

std::string guid_of(std::string_view model_json) {
  const std::span<const char> text(model_json);
  std::array<char, 64> guid{};
  std::snprintf(guid.data(), guid.size(), "{kelpie-%08x-%zx}", file::crc32_of(std::as_bytes(text)),
                model_json.size());
  return guid.data();
}

}  // namespace kelpie::fmu
