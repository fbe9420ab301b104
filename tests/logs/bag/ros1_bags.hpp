// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bzlib.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bag/compression.hpp"

namespace kelpie::testing {

/// Puts a bag of ROS 1, version 2.0, together. Its messages stand in one chunk each call of
/// chunk().
class Ros1Bag {
 public:
  template <typename T>
  static std::string raw(T value) {
    const auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
    return {bytes.data(), bytes.size()};
  }
  static std::string text(std::string_view value) {
    return raw(static_cast<std::uint32_t>(value.size())) + std::string(value);
  }
  using Fields = std::vector<std::pair<std::string, std::string>>;
  static std::string fields_of(const Fields& fields) {
    std::string all;
    for (const auto& [name, value] : fields) {
      all += text(name + "=" + value);
    }
    return all;
  }
  static std::string record(char op, Fields fields, std::string_view data) {
    fields.emplace_back("op", std::string(1, op));
    return text(fields_of(fields)) + text(data);
  }

  /// A connection; its number.
  std::uint32_t connect(const std::string& topic, const std::string& type,
                        const std::string& definition, const std::string& checksum = "1",
                        bool is_latched = false) {
    const std::uint32_t id = connections_++;
    const std::string one = record(7, {{"conn", raw(id)}, {"topic", topic}},
                                   fields_of({{"topic", topic},
                                              {"type", type},
                                              {"md5sum", checksum},
                                              {"latching", is_latched ? "1" : "0"},
                                              {"message_definition", definition}}));
    chunk_ += one;
    index_ += one;
    return id;
  }
  Ros1Bag& add(std::uint32_t connection, std::uint32_t sec, std::uint32_t nanosec,
               std::string_view data) {
    chunk_ += record(2, {{"conn", raw(connection)}, {"time", raw(sec) + raw(nanosec)}}, data);
    ++messages_;
    return *this;
  }
  /// Closes the chunk at hand: "none", "bz2" or "lz4".
  Ros1Bag& chunk(const std::string& compression = "none") {
    chunks_.push_back(
        record(5, {{"compression", compression}, {"size", raw(size_of(chunk_))}},
               compression == "lz4"   ? bag::pack("lz4", chunk_)
               : compression == "bz2" ? pack_bz2(chunk_)
                                      : chunk_) +
        record(4, {{"ver", raw(std::uint32_t{1})}, {"conn", raw(std::uint32_t{0})}}, ""));
    infos_ += record(6, {{"count", raw(std::uint32_t{1})}},
                     raw(std::uint32_t{0}) + raw(std::exchange(messages_, 0)));
    chunk_.clear();
    return *this;
  }

  const std::string& open_chunk() const { return chunk_; }  ///< what chunk() hasn't closed

  /// The file. Not closed: as a recorder leaves it that dies.
  std::string file(bool is_closed = true, const Fields& more = {}) const {
    std::string data;
    for (const std::string& one : chunks_) {
      data += one;
    }
    const std::string begin = "#ROSBAG V2.0\n";
    Fields fields{{"chunk_count", raw(size_of(chunks_))}, {"index_pos", raw(std::uint64_t{0})}};
    fields.insert(fields.end(), more.begin(), more.end());
    if (is_closed) {
      const std::size_t head = begin.size() + record(3, fields, "    ").size();
      fields[1].second = raw(static_cast<std::uint64_t>(head + data.size()));
    }
    return begin + record(3, fields, "    ") + data + (is_closed ? index_ + infos_ : "");
  }

 private:
  template <typename Many>
  static std::uint32_t size_of(const Many& many) {
    return static_cast<std::uint32_t>(many.size());
  }
  static std::string pack_bz2(std::string bytes) {
    auto size = static_cast<unsigned int>(bytes.size() + bytes.size() / 50 + 1000);
    std::string packed(size, '\0');
    BZ2_bzBuffToBuffCompress(packed.data(), &size, bytes.data(), size_of(bytes), 9, 0, 0);
    packed.resize(size);
    return packed;
  }

  std::uint32_t connections_ = 0;
  std::uint32_t messages_ = 0;
  std::string chunk_;
  std::vector<std::string> chunks_;
  std::string index_;
  std::string infos_;
};

/// Definitions as ROS 1 records them.
inline constexpr const char* kRos1Stamped =
    "Header header\nfloat64 x\nbyte b\nchar c\nduration[2] d\nstring s\nuint8[] raw\n"
    "====\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n";

/// A message by kRos1Stamped.
inline std::string ros1_stamped(std::uint32_t sec, double x) {
  using B = Ros1Bag;
  return B::raw(std::uint32_t{7}) + B::raw(sec) + B::raw(std::uint32_t{500'000'000}) +
         B::text("map") + B::raw(x) + B::raw(std::int8_t{-2}) + B::raw(std::uint8_t{254}) +
         B::raw(std::int32_t{-1}) + B::raw(std::int32_t{2}) + B::raw(std::int32_t{3}) +
         B::raw(std::int32_t{4}) + B::text("\xFF\xFE") + B::text("abc");
}

/// `count` messages on /a by two connections in turn, x = k, received at 100 + k s, in chunks of
/// two; and one of std_msgs/Empty on /e first.
inline Ros1Bag small_ros1(std::size_t count, const std::string& compression = "none") {
  Ros1Bag bag;
  const std::uint32_t empty = bag.connect("/e", "std_msgs/Empty", "\n");
  const std::uint32_t first = bag.connect("/a", "x_msgs/Stamped", kRos1Stamped, "2", true);
  const std::uint32_t second = bag.connect("/a", "x_msgs/Stamped", kRos1Stamped, "2");
  bag.add(empty, 99, 0, "");
  for (std::size_t k = 0; k < count; ++k) {
    const auto sec = static_cast<std::uint32_t>(k);
    bag.add(k % 2 == 0 ? first : second, 100 + sec, 250'000'000,
            ros1_stamped(90 + sec, static_cast<double>(k)));
    if (k % 2 == 1) {
      bag.chunk(compression);
    }
  }
  return bag;
}

}  // namespace kelpie::testing
