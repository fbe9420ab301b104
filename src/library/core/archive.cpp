// SPDX-License-Identifier: Apache-2.0
#include "kelpie/core/archive.hpp"

#include <bit>
#include <cmath>
#include <type_traits>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie {
namespace {

constexpr unsigned kByte = 8;
constexpr std::size_t kMostText = std::size_t{1} << 20;

template <typename Bits>
void encode(Bits bits, char* to) {
  for (std::size_t i = 0; i < sizeof(Bits); ++i) {
    to[i] = static_cast<char>(static_cast<unsigned char>(bits >> (kByte * i)));
  }
}

template <typename Bits>
Bits decode(const char* from) {
  Bits bits = 0;
  for (std::size_t i = 0; i < sizeof(Bits); ++i) {
    bits |= static_cast<Bits>(static_cast<unsigned char>(from[i])) << (kByte * i);
  }
  return bits;
}

}  // namespace

char* Archive::put(std::size_t size) {
  const std::size_t at = bytes_.size();
  bytes_.resize(at + size);
  return bytes_.data() + at;
}

const char* Archive::take(std::size_t size) {
  require(size <= left_.size(), "ends too early");
  const char* const from = left_.data();
  left_.remove_prefix(size);
  return from;
}

template <typename Number>
void Archive::all(std::span<Number> values, bool finite) {
  using Bits = std::conditional_t<sizeof(Number) == sizeof(double), std::uint64_t, std::uint32_t>;
  bool good = true;
  if (!loading_) {
    char* const to = put(values.size_bytes());
    for (std::size_t i = 0; i < values.size(); ++i) {
      encode(std::bit_cast<Bits>(values[i]), to + i * sizeof(Number));
      good = good && std::isfinite(values[i]);
    }
  } else {
    const char* const from = take(values.size_bytes());
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = std::bit_cast<Number>(decode<Bits>(from + i * sizeof(Number)));
      good = good && std::isfinite(values[i]);
    }
  }
  require(good || !finite, "holds a number that isn't finite");
}

void Archive::number(double& value) {
  all(std::span(&value, 1), true);
}

void Archive::numbers(std::span<double> values) {
  all(values, true);
}

void Archive::numbers(std::span<float> values) {
  all(values, true);
}

void Archive::any_number(double& value) {
  all(std::span(&value, 1), false);
}

void Archive::whole_number(std::int64_t& value, std::int64_t least, std::int64_t most) {
  if (!loading_) {
    encode(static_cast<std::uint64_t>(value), put(sizeof value));
    return;
  }
  value = static_cast<std::int64_t>(decode<std::uint64_t>(take(sizeof value)));
  require(value >= least && value <= most, "holds a number that is out of range");
}

void Archive::flag(bool& value) {
  int bit = value ? 1 : 0;
  whole(bit, 0, 1);
  if (loading_) {
    value = bit == 1;
  }
}

void Archive::length(std::size_t& size, std::size_t most, std::size_t item_bytes) {
  whole(size);
  require(size <= most, "is longer than there is room for");
  require(!loading_ || size <= left_.size() / item_bytes, "ends too early");
}

void Archive::text(std::string& value) {
  std::size_t size = value.size();
  length(size, kMostText, 1);
  if (loading_) {
    value.assign(take(size), size);
  } else {
    value.copy(put(size), size);
  }
}

void Archive::same(std::string_view field, const std::string& here) {
  std::string there = here;
  text(there);
  if (there != here) {
    throw InputError(std::string(field),
                     "is '" + there + "' in what was saved, '" + here + "' here");
  }
}

void Archive::require(bool good, std::string_view otherwise) const {
  if (!good) {
    throw InputError({.file = {},
                      .line = 0,
                      .field = path_.empty() ? "state" : "state." + join_text(path_, ".")},
                     std::string(otherwise));
  }
}

}  // namespace kelpie
