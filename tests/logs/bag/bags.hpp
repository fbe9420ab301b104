// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "bag/mcap_reader.hpp"
#include "bag/mcap_writer.hpp"
#include "bag/reader.hpp"
#include "support.hpp"

namespace kelpie::testing {

using Bytes = std::vector<std::byte>;

inline std::span<const std::byte> as_bytes(std::string_view text) {
  return std::as_bytes(std::span(text));
}

inline std::string read_text(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Puts a CDR message together, aligned as the standard asks for.
class CdrMessage {
 public:
  explicit CdrMessage(std::endian order = std::endian::little) : order_(order) {
    bytes_ = {std::byte{0}, order == std::endian::little ? std::byte{1} : std::byte{0},
              std::byte{0}, std::byte{0}};
  }

  template <typename T>
  CdrMessage& add(T value) {
    while ((bytes_.size() - 4) % sizeof(T) != 0) {
      bytes_.push_back(std::byte{0xEE});
    }
    auto raw = std::bit_cast<std::array<std::byte, sizeof(T)>>(value);
    if (order_ != std::endian::native) {
      std::ranges::reverse(raw);
    }
    bytes_.insert(bytes_.end(), raw.begin(), raw.end());
    return *this;
  }
  CdrMessage& text(std::string_view value) {
    add(static_cast<std::uint32_t>(value.size() + 1));
    const std::span<const std::byte> letters = as_bytes(value);
    bytes_.insert(bytes_.end(), letters.begin(), letters.end());
    bytes_.push_back(std::byte{0});
    return *this;
  }
  CdrMessage& header(std::int32_t sec, std::uint32_t nanosec) {
    return add(sec).add(nanosec).text("base_link");
  }

  const Bytes& bytes() const { return bytes_; }

 private:
  std::endian order_;
  Bytes bytes_;
};

/// A geometry_msgs/TwistStamped whose linear.x is `x`.
inline Bytes twist_stamped(std::int32_t sec, double x) {
  CdrMessage message;
  message.header(sec, 0).add(x);
  for (int i = 0; i < 5; ++i) {
    message.add(0.0);
  }
  return message.bytes();
}

/// A std_msgs/Float64MultiArray without dimensions.
inline Bytes float_array(const std::vector<double>& values) {
  CdrMessage message;
  message.add(std::uint32_t{0}).add(std::uint32_t{0});
  message.add(static_cast<std::uint32_t>(values.size()));
  for (const double value : values) {
    message.add(value);
  }
  return message.bytes();
}

struct Recorded {
  std::size_t topic;
  std::int64_t receive_ns;
  Bytes data;
};

constexpr std::int64_t kSecond = 1'000'000'000;

/// /odom (TwistStamped) every second, /thrusters (Float64MultiArray) half a second later.
inline const std::vector<bag::Topic>& small_topics() {
  static const std::vector<bag::Topic> topics{
      {.name = "/odom", .type = "geometry_msgs/msg/TwistStamped"},
      {.name = "/thrusters", .type = "std_msgs/msg/Float64MultiArray"},
  };
  return topics;
}

inline std::vector<Recorded> small_messages(int seconds) {
  std::vector<Recorded> messages;
  for (int k = 0; k < seconds; ++k) {
    messages.push_back({0, (10 + k) * kSecond, twist_stamped(5 + k, 0.25 * k)});
    messages.push_back({1, (10 + k) * kSecond + kSecond / 2, float_array({1.0 * k, -2.0 * k})});
  }
  return messages;
}

inline bag::Message message_of(const Recorded& recorded) {
  return {.topic = recorded.topic,
          .receive_ns = recorded.receive_ns,
          .publish_ns = recorded.receive_ns,
          .data = recorded.data};
}

inline std::string mcap_of(const std::vector<bag::Topic>& topics,
                           const std::vector<Recorded>& messages,
                           const bag::McapWriter::Settings& settings = {}) {
  bag::McapWriter writer(settings);
  for (const bag::Topic& topic : topics) {
    writer.add_topic(topic);
  }
  for (const Recorded& recorded : messages) {
    writer.write(message_of(recorded));
  }
  return writer.finish();
}

/// A small MCAP file of several chunks.
inline std::string small_mcap(const std::string& compression = "zstd", int seconds = 6) {
  return mcap_of(small_topics(), small_messages(seconds),
                 {.compression = compression, .chunk_bytes = 400});
}

/// What is left of a bag once it is read.
struct Content {
  std::vector<bag::Topic> topics;
  std::vector<Recorded> messages;
  std::vector<std::string> losses;
};

inline Content content_of(bag::MessageReader& bag) {
  Content content;
  for (bag::Message message; bag.next(message);) {
    content.messages.push_back(
        {message.topic, message.receive_ns, {message.data.begin(), message.data.end()}});
  }
  content.topics = bag.topics();
  content.losses = bag.losses();
  return content;
}

inline Content read_all(std::string_view mcap, bag::ReadMode mode = bag::ReadMode::strict) {
  return content_of(*bag::read_mcap(as_bytes(mcap), "small.mcap", mode));
}

/// Writes a .db3 file as rosbag2 of ROS 2 Humble does.
inline void write_db3(const std::filesystem::path& file, const std::vector<bag::Topic>& topics,
                      const std::vector<Recorded>& messages) {
  sqlite3* raw = nullptr;
  if (sqlite3_open(file.c_str(), &raw) != SQLITE_OK) {
    throw std::runtime_error("no database");
  }
  const std::unique_ptr<sqlite3, decltype(&sqlite3_close)> database(raw, &sqlite3_close);
  sqlite3_exec(raw,
               "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT "
               "NULL, serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);"
               "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp "
               "INTEGER NOT NULL, data BLOB NOT NULL); BEGIN;",
               nullptr, nullptr, nullptr);
  sqlite3_stmt* insert = nullptr;
  sqlite3_prepare_v2(raw, "INSERT INTO topics VALUES(?, ?, ?, 'cdr', '')", -1, &insert, nullptr);
  for (std::size_t k = 0; k < topics.size(); ++k) {
    sqlite3_bind_int64(insert, 1, static_cast<std::int64_t>(k) + 1);
    sqlite3_bind_text(insert, 2, topics[k].name.c_str(), -1, SQLITE_STATIC);
    sqlite3_bind_text(insert, 3, topics[k].type.c_str(), -1, SQLITE_STATIC);
    sqlite3_step(insert);
    sqlite3_reset(insert);
  }
  sqlite3_finalize(insert);
  sqlite3_prepare_v2(raw, "INSERT INTO messages VALUES(NULL, ?, ?, ?)", -1, &insert, nullptr);
  for (const Recorded& message : messages) {
    sqlite3_bind_int64(insert, 1, static_cast<std::int64_t>(message.topic) + 1);
    sqlite3_bind_int64(insert, 2, message.receive_ns);
    sqlite3_bind_blob(insert, 3, message.data.data(), static_cast<int>(message.data.size()),
                      SQLITE_STATIC);
    sqlite3_step(insert);
    sqlite3_reset(insert);
  }
  sqlite3_finalize(insert);
  sqlite3_exec(raw, "COMMIT", nullptr, nullptr, nullptr);
}

}  // namespace kelpie::testing
