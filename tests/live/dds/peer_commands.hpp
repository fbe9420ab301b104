// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iostream>
#include <memory>
#include <mutex>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "dds/swimming.hpp"

namespace kelpie::testing {

using Bytes = std::vector<std::byte>;

inline std::string hex_of(const Bytes& bytes) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const std::byte byte : bytes) {
    text += kDigits[static_cast<std::size_t>(byte) / 16];
    text += kDigits[static_cast<std::size_t>(byte) % 16];
  }
  return text;
}

inline Bytes bytes_of_hex(const std::string& text) {
  Bytes bytes;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2) {
    bytes.push_back(static_cast<std::byte>(std::stoul(text.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

/// What a peer can do with some implementation of DDS; the last thing opened is the one that is
/// spoken of.
class PeerActions {
 public:
  virtual ~PeerActions() = default;
  virtual void publish(const std::string& topic, const std::string& type, bool reliable) = 0;
  virtual void subscribe(const std::string& topic, const std::string& type, bool reliable) = 0;
  virtual void send(const Bytes& cdr) = 0;
  /// Sends a nav_msgs/Odometry of this time and forward velocity in CDR of its own making.
  virtual void send_odometry(std::int32_t sec, double velocity) = 0;
  /// The same of all of a vehicle, on the first topic opened, after its forces as a
  /// geometry_msgs/WrenchStamped on the second.
  virtual void send_motion(const Swimming& vehicle) = 0;
  virtual void send_text(const std::string& text) = 0;  ///< As a std_msgs/String.
};

/// What is sent until the first of it is heard: before that a reliable connection isn't one yet.
inline const Bytes& hello() {
  static const Bytes bytes = bytes_of_hex("0001000068656c6c");
  return bytes;
}

/// One line to whoever started the peer, from any thread.
inline void say(const std::string& line) {
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  std::cout << line << std::endl;
}

/// Tells of a message that came.
inline void say_heard(const Bytes& cdr) {
  say(cdr == hello() ? "hello" : "got " + hex_of(cdr));
}

/// Does what the lines of standard input say, until they end:
///   publish TOPIC TYPE reliable|best_effort, subscribe TOPIC TYPE reliable|best_effort,
///   send HEX, odometry SECONDS VELOCITY, text WORD,
///   mission COUNT RATE (steps of the vehicle, which go on where they were), day COUNT RATE (the
///   same from its beginning),
///   stream RATE COUNT BYTES (messages that begin with their number and the time in ns)
/// Each is answered by a line with its first word once it is done.
inline int run_peer(PeerActions& actions) {
  Swimming vehicle;
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream words(line);
    std::string command;
    words >> command;
    if (command == "publish" || command == "subscribe") {
      std::string topic;
      std::string type;
      std::string reliability;
      words >> topic >> type >> reliability;
      command == "publish" ? actions.publish(topic, type, reliability == "reliable")
                           : actions.subscribe(topic, type, reliability == "reliable");
    } else if (command == "send") {
      std::string hex;
      words >> hex;
      actions.send(bytes_of_hex(hex));
    } else if (command == "odometry") {
      std::int32_t sec = 0;
      double velocity = 0.0;
      words >> sec >> velocity;
      actions.send_odometry(sec, velocity);
    } else if (command == "text") {
      std::string text;
      words >> text;
      actions.send_text(text);
    } else if (command == "mission" || command == "day") {
      int count = 0;
      double rate = 0.0;
      words >> count >> rate;
      vehicle = command == "day" ? Swimming() : vehicle;
      const auto begin = std::chrono::steady_clock::now();
      for (int k = 0; k < count; ++k) {
        std::this_thread::sleep_until(begin + std::chrono::nanoseconds(static_cast<std::int64_t>(
                                                  1e9 * static_cast<double>(k) / rate)));
        vehicle.step();
        actions.send_motion(vehicle);
      }
    } else if (command == "stream") {
      double rate = 0.0;
      std::uint64_t count = 0;
      std::size_t size = 0;
      words >> rate >> count >> size;
      const auto begin = std::chrono::steady_clock::now();
      for (std::uint64_t k = 0; k < count; ++k) {
        std::this_thread::sleep_until(begin + std::chrono::nanoseconds(static_cast<std::int64_t>(
                                                  1e9 * static_cast<double>(k) / rate)));
        Bytes cdr(size);
        const std::int64_t now = std::chrono::duration_cast<std::chrono::nanoseconds>(
                                     std::chrono::system_clock::now().time_since_epoch())
                                     .count();
        std::memcpy(cdr.data() + 4, &k, sizeof k);
        std::memcpy(cdr.data() + 12, &now, sizeof now);
        cdr[1] = std::byte{1};
        actions.send(cdr);
      }
    }
    say(command);
  }
  return 0;
}

}  // namespace kelpie::testing
