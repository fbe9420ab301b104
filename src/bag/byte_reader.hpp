// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "kelpie/core/error.hpp"
#include "wire/scalar.hpp"

namespace kelpie::bag {

using wire::number_at;

/// Bytes of a file, or of a chunk unpacked from it, and where they stand.
struct Region {
  std::string file{};
  std::string part{};  ///< "" or "chunk at offset 1234, "

  [[noreturn]] void refuse(std::uint64_t offset, const std::string& message) const {
    throw InputError({.file = file, .line = 0, .field = part + "offset " + std::to_string(offset)},
                     message);
  }
};

/// Reads little-endian fields one after the other. Every length is checked against what is left;
/// throws InputError (file, offset) otherwise. Views point into the bytes read.
class ByteReader {
 public:
  ByteReader(std::span<const std::byte> bytes, const Region& region, std::uint64_t offset)
      : bytes_(bytes), region_(region), offset_(offset) {}

  template <std::unsigned_integral T>
  T number() {
    return number_at<T>(take(sizeof(T)), std::endian::little);
  }

  std::span<const std::byte> take(std::uint64_t length) {
    if (length > left()) {
      refuse("is cut off: " + std::to_string(length) + " bytes are due, " + std::to_string(left()) +
             " are left");
    }
    const std::span<const std::byte> taken = bytes_.subspan(at_, static_cast<std::size_t>(length));
    at_ += taken.size();
    return taken;
  }

  std::string_view text() {
    const std::span<const std::byte> bytes = take(number<std::uint32_t>());
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};  // NOLINT: bytes as text
  }

  std::span<const std::byte> rest() { return take(left()); }
  std::uint64_t left() const { return bytes_.size() - at_; }
  std::uint64_t offset() const { return offset_ + at_; }
  [[noreturn]] void refuse(const std::string& message) const { region_.refuse(offset(), message); }

 private:
  std::span<const std::byte> bytes_;
  const Region& region_;
  std::uint64_t offset_;
  std::size_t at_ = 0;
};

}  // namespace kelpie::bag
