// SPDX-License-Identifier: Apache-2.0
#include "wire/scalar.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

namespace kelpie::scalar_test {
namespace {

using wire::FieldKind;

constexpr std::array<FieldKind, 11> kNumbers{
    FieldKind::boolean, FieldKind::int8,    FieldKind::uint8,  FieldKind::int16,
    FieldKind::uint16,  FieldKind::int32,   FieldKind::uint32, FieldKind::int64,
    FieldKind::uint64,  FieldKind::float32, FieldKind::float64};

RC_GTEST_PROP(Scalar, WhatAKindHoldsIsStoredAndReadBack, (double any, std::int32_t whole)) {
  for (const FieldKind kind : kNumbers) {
    for (const double value : {any, static_cast<double>(whole), 0.0, 1.0}) {
      if (wire::holds(kind, value)) {
        std::array<std::byte, 8> bytes{};
        wire::store_number(bytes, kind, value);
        const double back = wire::number_of(kind, bytes, std::endian::little);
        RC_ASSERT(
            back ==
            (kind == FieldKind::float32 ? static_cast<double>(static_cast<float>(value)) : value));
        std::reverse(bytes.begin(), bytes.begin() + wire::bytes_of(kind));
        RC_ASSERT(wire::number_of(kind, bytes, std::endian::big) == back);
      }
    }
  }
}

TEST(Scalar, IntegersHoldWholeNumbersWithinTheirRange) {
  EXPECT_TRUE(wire::holds(FieldKind::int8, -128));
  EXPECT_FALSE(wire::holds(FieldKind::int8, -129));
  EXPECT_FALSE(wire::holds(FieldKind::uint8, 256));
  EXPECT_FALSE(wire::holds(FieldKind::uint8, 0.5));
  EXPECT_FALSE(wire::holds(FieldKind::boolean, 2));
  EXPECT_TRUE(wire::holds(FieldKind::uint64, 18446744073709549568.0));
  EXPECT_FALSE(wire::holds(FieldKind::uint64, 18446744073709551616.0));
  EXPECT_FALSE(wire::holds(FieldKind::int64, 9223372036854775808.0));
  EXPECT_FALSE(wire::holds(FieldKind::int32, std::numeric_limits<double>::quiet_NaN()));
  EXPECT_TRUE(wire::holds(FieldKind::float32, std::numeric_limits<double>::quiet_NaN()));
}

// IEEE 754: one, the largest, the smallest normal and subnormal, zeros, infinities, NaN.
TEST(Scalar, HalvesAreRead) {
  const auto half = [](std::uint16_t bits) {
    const auto raw = std::bit_cast<std::array<std::byte, 2>>(bits);
    return wire::number_of(FieldKind::float16, raw, std::endian::native);
  };
  EXPECT_EQ(half(0x3C00), 1.0);
  EXPECT_EQ(half(0xC100), -2.5);
  EXPECT_EQ(half(0x7BFF), 65504.0);
  EXPECT_EQ(half(0x0400), 0x1p-14);
  EXPECT_EQ(half(0x0001), 0x1p-24);
  EXPECT_TRUE(std::signbit(half(0x8000)));
  EXPECT_EQ(half(0xFC00), -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(half(0x7E00)));
  EXPECT_EQ(wire::bytes_of(FieldKind::float16), 2U);
  EXPECT_FALSE(wire::holds(FieldKind::float16, 1.0));  // only read
}

}  // namespace
}  // namespace kelpie::scalar_test
