// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace kelpie {

/// Number format of a kernel matrix.
enum class Storage : std::uint8_t {
  float64,  ///< as computed
  float32,  ///< rounded to 24 bits, half the memory
};

}  // namespace kelpie
