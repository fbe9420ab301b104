// SPDX-License-Identifier: Apache-2.0
#include "wire/scalar.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace kelpie::wire {

std::string text_of(std::span<const std::byte> bytes) {
  const auto* const text = reinterpret_cast<const char*>(bytes.data());  // NOLINT: bytes as text
  return {text, std::find(text, text + bytes.size(), '\0')};
}

bool holds(FieldKind kind, double value) {
  if (kind == FieldKind::boolean) {
    return value == 0.0 || value == 1.0;
  }
  return with_type(kind, [&](auto zero) {
    using T = decltype(zero);
    if constexpr (std::is_floating_point_v<T>) {
      return true;
    } else if constexpr (std::is_same_v<T, Half>) {
      return false;
    } else {
      // The upper end may not be a double itself, but the power of two above it is.
      return std::trunc(value) == value &&
             value >= static_cast<double>(std::numeric_limits<T>::min()) &&
             value < std::ldexp(1.0, std::numeric_limits<T>::digits);
    }
  });
}

void store_number(std::span<std::byte> place, FieldKind kind, double value) {
  with_type(kind, [&](auto zero) {
    using T = decltype(zero);
    if constexpr (!std::is_same_v<T, Half>) {
      auto raw = std::bit_cast<std::array<std::byte, sizeof(T)>>(static_cast<T>(value));
      if constexpr (std::endian::native == std::endian::big) {
        std::ranges::reverse(raw);
      }
      std::ranges::copy(raw, place.begin());
    }
  });
}

}  // namespace kelpie::wire
