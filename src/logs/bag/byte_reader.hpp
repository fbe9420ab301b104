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

/// The same bytes as text.
inline std::string_view text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};  // NOLINT: bytes as text
}

/// A file, or a chunk unpacked from a file, for error messages.
struct Region {
  std::string file{};
  std::string part{};  ///< "" or "chunk at offset 1234, "

  InputError error(std::uint64_t offset, const std::string& message) const {
    return {Place{.file = file, .field = part + "offset " + std::to_string(offset)}, message};
  }
  [[noreturn]] void refuse(std::uint64_t offset, const std::string& message) const {
    throw error(offset, message);
  }
};

/// Reads consecutive little-endian fields, and checks every length against the remaining bytes.
/// Throws InputError (file, offset) on missing bytes. Views point into the bytes read.
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

  std::string_view text() { return text_of(take(number<std::uint32_t>())); }

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
