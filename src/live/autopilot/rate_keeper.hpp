// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kelpie::autopilot {

/// Keeps the rates of a vehicle's messages: chooses the next request, and describes messages that
/// come too slowly. Without a line or a clock of its own.
class RateKeeper {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// A message and its wanted rate.
  struct MessageRate {
    std::string name;      ///< "ATTITUDE"
    std::uint32_t id = 0;  ///< number of the message
    double rate_hz = 0.0;  ///< at least
  };

  static constexpr int kAccepted = 0;  ///< results of COMMAND_ACK (MAV_RESULT)
  static constexpr int kInProgress = 5;

  explicit RateKeeper(const std::vector<MessageRate>& wanted);

  /// Counts a message of the vehicle.
  void count_message(std::uint32_t id, Time now);
  /// Takes the vehicle's answer to the last request.
  void acknowledge(int result, Time now);
  /// The request due now, if any. Each request waits for the answer to the previous one, at most
  /// Tuning::longest_answer.
  std::optional<MessageRate> next_request(Time now);

  /// Messages below their rate, a sentence each.
  std::vector<std::string> faults() const;

 private:
  struct State {
    MessageRate wanted;
    std::size_t count = 0;  // since the last measurement
    std::optional<Time> asked{};
    std::optional<int> refused{};
    std::string slow{};  // the sentence; empty: fast enough
  };

  void measure(Time now);

  std::vector<State> states_;
  std::optional<Time> measured_;
  std::optional<std::size_t> requested_;  // waits for its answer
};

}  // namespace kelpie::autopilot
