// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace kelpie::ros {

constexpr const char* kTextType = "std_msgs/msg/String";

/// What a std_msgs/String in plain CDR says; nothing where the bytes are none.
std::optional<std::string> text_of(std::span<const std::byte> cdr);

}  // namespace kelpie::ros
