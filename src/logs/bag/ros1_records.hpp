// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "bag/byte_reader.hpp"

namespace kelpie::bag {

// The records of ROS 1's bags, version 2.0 (http://wiki.ros.org/Bags/Format/2.0).

constexpr std::string_view kRos1Magic = "#ROSBAG V";
constexpr std::string_view kRos1Version = "#ROSBAG V2.0\n";

enum class Ros1Op : std::uint8_t {
  message = 0x02,
  bag = 0x03,
  index = 0x04,
  chunk = 0x05,
  chunk_info = 0x06,
  connection = 0x07,
};

/// Consecutive fields "name=value" with lengths: the header of a record, or the data of a
/// connection.
class Ros1Fields {
 public:
  Ros1Fields() = default;
  /// Throws InputError (file, offset) on bytes that are not fields; `bytes` begin at `offset`.
  Ros1Fields(std::span<const std::byte> bytes, const Region& region, std::uint64_t offset);

  /// Whether the bytes consist of fields.
  static bool are(std::span<const std::byte> bytes);

  /// The value of a field, if present. Requires the region to be alive, as number() does.
  std::optional<std::string_view> find(std::string_view name) const;
  /// Throws InputError (file, offset) without a field of this name and size.
  template <std::unsigned_integral T>
  T number(std::string_view name) const {
    return number_at<T>(std::as_bytes(std::span(value(name, sizeof(T)))), std::endian::little);
  }
  /// As above, of any size.
  std::string_view text(std::string_view name) const;

 private:
  std::string_view value(std::string_view name, std::size_t size) const;

  std::span<const std::byte> bytes_;
  const Region* region_ = nullptr;
  std::uint64_t offset_ = 0;
};

struct Ros1Record {
  Ros1Op op{};
  Ros1Fields header;
  std::span<const std::byte> data;
  std::uint64_t offset = 0;       ///< in the region
  std::uint64_t data_offset = 0;  ///< the same of `data`
};

/// Walks over consecutive records.
class Ros1Cursor {
 public:
  Ros1Cursor() = default;
  explicit Ros1Cursor(std::span<const std::byte> bytes, std::uint64_t at = 0)
      : bytes_(bytes), at_(at) {}

  bool done() const { return at_ >= bytes_.size(); }

  /// Returns the record here and moves behind the record. Requires !done(). Throws InputError on an
  /// incomplete record; the cursor is then at the next whole record, or at the end.
  Ros1Record next(const Region& region);

 private:
  std::span<const std::byte> bytes_;
  std::uint64_t at_ = 0;
};

}  // namespace kelpie::bag
