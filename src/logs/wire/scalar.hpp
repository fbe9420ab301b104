// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kelpie::wire {

/// Kind of an element of a message's field, in any format.
enum class FieldKind : std::uint8_t {
  boolean,
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float16,
  float32,
  float64,
  string,      ///< text behind a length
  characters,  ///< text in a fixed number of bytes, possibly ended by a zero
  structure,   ///< fields of a structure
};

/// Whether the kind is a number, boolean to float64, as the functions below require.
constexpr bool is_number(FieldKind kind) {
  return kind < FieldKind::string;
}

/// A number at the start of `bytes`, stored in the given byte order. Requires enough bytes.
template <typename T>
T number_at(std::span<const std::byte> bytes, std::endian order) {
  std::array<std::byte, sizeof(T)> raw{};
  std::copy_n(bytes.begin(), sizeof(T), raw.begin());
  if (order != std::endian::native) {
    std::ranges::reverse(raw);
  }
  return std::bit_cast<T>(raw);
}

/// IEEE 754's binary16, missing in C++20.
struct Half {
  std::uint16_t bits = 0;

  explicit operator double() const {
    const int exponent = bits >> 10U & 0x1F;
    const int fraction = bits & 0x3FF;
    const double size = exponent == 0x1F
                            ? (fraction == 0 ? std::numeric_limits<double>::infinity()
                                             : std::numeric_limits<double>::quiet_NaN())
                        : exponent == 0 ? std::ldexp(fraction, -24)
                                        : std::ldexp(fraction + 0x400, exponent - 25);
    return (bits & 0x8000) != 0 ? -size : size;
  }
};

/// Calls `function` with a zero of the stored type of the kind.
template <typename Function>
constexpr auto with_type(FieldKind kind, Function function) {
  switch (kind) {
    case FieldKind::int8:
      return function(std::int8_t{});
    case FieldKind::int16:
      return function(std::int16_t{});
    case FieldKind::uint16:
      return function(std::uint16_t{});
    case FieldKind::int32:
      return function(std::int32_t{});
    case FieldKind::uint32:
      return function(std::uint32_t{});
    case FieldKind::int64:
      return function(std::int64_t{});
    case FieldKind::uint64:
      return function(std::uint64_t{});
    case FieldKind::float16:
      return function(Half{});
    case FieldKind::float32:
      return function(float{});
    case FieldKind::float64:
      return function(double{});
    default:
      return function(std::uint8_t{});
  }
}

/// How many bytes such a number takes.
constexpr std::size_t bytes_of(FieldKind kind) {
  return with_type(kind, [](auto zero) { return sizeof(zero); });
}

/// The number at the start of `bytes`. Requires enough bytes. Integers beyond 2⁵³ are rounded; a
/// boolean is 0 or 1.
inline double number_of(FieldKind kind, std::span<const std::byte> bytes, std::endian order) {
  if (kind == FieldKind::boolean) {
    return bytes.front() == std::byte{0} ? 0.0 : 1.0;
  }
  return with_type(kind, [&](auto zero) {
    return static_cast<double>(number_at<decltype(zero)>(bytes, order));
  });
}

/// A text in a fixed number of bytes, up to the first zero.
std::string text_of(std::span<const std::byte> bytes);

/// Whether the kind can store `value`: integers within range. A float16 is only read.
bool holds(FieldKind kind, double value);

/// Stores a number at the start of `place`, little-endian. Requires enough bytes and holds().
void store_number(std::span<std::byte> place, FieldKind kind, double value);

/// C's name of a kind, as in the definitions of MAVLink and ULog.
struct CName {
  std::string_view word;
  FieldKind kind;
};

constexpr std::array<CName, 12> kCNames{{
    {"bool", FieldKind::boolean},
    {"char", FieldKind::characters},
    {"int8_t", FieldKind::int8},
    {"uint8_t", FieldKind::uint8},
    {"int16_t", FieldKind::int16},
    {"uint16_t", FieldKind::uint16},
    {"int32_t", FieldKind::int32},
    {"uint32_t", FieldKind::uint32},
    {"int64_t", FieldKind::int64},
    {"uint64_t", FieldKind::uint64},
    {"float", FieldKind::float32},
    {"double", FieldKind::float64},
}};

}  // namespace kelpie::wire
