// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kelpie::autopilot {

/// Sees to it that a vehicle's messages come often enough: says what is to be asked for, one after
/// the other, and what the vehicle won't do. Knows no line and no clock of its own.
class RateKeeper {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// A message that is wanted.
  struct MessageRate {
    std::string name;      ///< "ATTITUDE"
    std::uint32_t id = 0;  ///< its number
    double rate_hz = 0.0;  ///< at least
  };

  static constexpr int kAccepted = 0;  ///< results of COMMAND_ACK (MAV_RESULT)
  static constexpr int kInProgress = 5;

  explicit RateKeeper(const std::vector<MessageRate>& wanted);

  /// A message of the vehicle.
  void count_message(std::uint32_t id, Time now);
  /// What the vehicle said to what was asked for last.
  void acknowledge(int result, Time now);
  /// What the vehicle is to be asked for now, if anything. Once it has been asked the next one has
  /// to wait for the answer, but not for longer than a second.
  std::optional<MessageRate> next_request(Time now);

  /// What doesn't come as it should, a sentence each.
  std::vector<std::string> faults() const;

 private:
  struct State {
    MessageRate wanted;
    std::size_t count = 0;  // since the last measurement
    std::optional<Time> asked{};
    std::optional<int> refused{};
    std::string slow{};  // the sentence; empty: it comes often enough
  };

  void measure(Time now);

  std::vector<State> states_;
  std::optional<Time> measured_;
  std::optional<std::size_t> requested_;  // an answer
};

}  // namespace kelpie::autopilot
