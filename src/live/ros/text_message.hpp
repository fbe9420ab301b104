// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace kelpie::ros {

constexpr const char* kTextType = "std_msgs/msg/String";

/// The text of a std_msgs/String in plain CDR; empty on other bytes.
std::optional<std::string> text_of(std::span<const std::byte> cdr);

}  // namespace kelpie::ros
