// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "bag/decoding.hpp"

namespace kelpie::bag {

/// The time since each MAVLink sender's boot, for counters of 32 bits in µs, such as
/// SERVO_OUTPUT_RAW.time_usec: such a counter overflows every 71.6 minutes, and its first stamp
/// does not tell how often. A sender's other messages tell.
class SenderTimes {
 public:
  /// Announces a topic in use, before any message.
  void expect(const std::string& topic);

  /// Takes note of a topic's message, or places an overflowing counter. False where the message is
  /// to be left out: an announced topic of the same sender is about to tell the time, within
  /// Tuning::longest_untimed_ns.
  bool settle(std::string_view topic, std::int64_t receive_ns, StampReader& stamp);

 private:
  struct Sender {
    bool is_expected = false;                  // to tell its time
    std::optional<std::int64_t> booted_ns{};   // by the receiver's clock
    std::optional<std::int64_t> untimed_ns{};  // reception of the first message left out
  };
  Sender& sender_of(std::string_view topic);

  std::map<std::string, Sender, std::less<>> senders_;
};

}  // namespace kelpie::bag
