// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace kelpie::testing {

/// Numbers and texts one right behind the other, little-endian.
class PackedBytes {
 public:
  template <typename T>
    requires std::is_arithmetic_v<T>
  PackedBytes& add(T value) {
    const auto raw = std::bit_cast<std::array<std::byte, sizeof(T)>>(value);
    bytes_.insert(bytes_.end(), raw.begin(), raw.end());
    return *this;
  }
  PackedBytes& add(std::string_view text) {
    for (const char letter : text) {
      bytes_.push_back(static_cast<std::byte>(letter));
    }
    return *this;
  }
  /// In so many bytes, with zeros behind it.
  PackedBytes& add(std::string_view text, std::size_t length) {
    add(text);
    bytes_.resize(bytes_.size() + length - text.size());
    return *this;
  }
  PackedBytes& add(const PackedBytes& other) {
    bytes_.insert(bytes_.end(), other.bytes_.begin(), other.bytes_.end());
    return *this;
  }

  std::vector<std::byte>& bytes() { return bytes_; }
  const std::vector<std::byte>& bytes() const { return bytes_; }
  std::size_t size() const { return bytes_.size(); }
  std::string text() const {
    return {reinterpret_cast<const char*>(bytes_.data()), bytes_.size()};  // NOLINT: bytes as text
  }

 private:
  std::vector<std::byte> bytes_;
};

}  // namespace kelpie::testing
