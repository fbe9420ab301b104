// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "wire/scalar.hpp"

namespace kelpie::wire {

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
