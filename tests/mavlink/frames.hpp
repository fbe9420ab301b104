// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "mavlink/frame_parser.hpp"

namespace kelpie::testing {

using Bytes = std::vector<std::byte>;

inline Bytes bytes_of_hex(const std::string& text) {
  Bytes bytes;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2) {
    bytes.push_back(static_cast<std::byte>(std::stoul(text.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

/// A number of a frame's message. Requires a field of this name.
inline double number_of(const mavlink::Frame& frame, const std::string& field,
                        std::size_t index = 0) {
  return mavlink::number_at(*frame.definition->find(field), frame.payload, index);
}

inline std::string text_of(const mavlink::Frame& frame, const std::string& field) {
  return mavlink::text_at(*frame.definition->find(field), frame.payload);
}

}  // namespace kelpie::testing
