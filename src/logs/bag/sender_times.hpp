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

/// The time since each MAVLink sender's boot, for counters of 32 bits: time_boot_ms overflows every
/// 49.7 days, SERVO_OUTPUT_RAW.time_usec every 71.6 minutes, and a stamp does not tell how often.
/// All stamps of a sender go on with the receiver's clock from the sender's last stamp; a stamp in
/// ms beyond Tuning::wrap_margin_ns says that the sender began anew, and the first stamp that none
/// has overflowed. A stamp in µs follows the sender's other messages.
class SenderTimes {
 public:
  /// Announces a topic in use, before any message.
  void expect(const std::string& topic);

  /// Takes note of a topic's message, and places an overflowing counter. False where the message is
  /// to be left out: a stamp in µs, while an announced topic of the same sender tells another time
  /// or is about to tell the time, within Tuning::longest_untimed_ns.
  bool settle(std::string_view topic, std::int64_t receive_ns, StampReader& stamp);

 private:
  struct Sender {
    bool is_expected = false;                  // to tell its time
    std::optional<std::int64_t> booted_ns{};   // by the receiver's clock
    std::optional<std::int64_t> untimed_ns{};  // reception of the first message left out
  };
  Sender& sender_of(std::string_view topic);
  static bool goes_on(const Sender& sender, std::int64_t receive_ns, StampReader& stamp);

  std::map<std::string, Sender, std::less<>> senders_;
};

}  // namespace kelpie::bag
