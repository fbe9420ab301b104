// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace kelpie::live {

/// Nanoseconds in s.
inline double seconds(std::int64_t nanoseconds) {
  return static_cast<double>(nanoseconds) / 1e9;
}

}  // namespace kelpie::live
