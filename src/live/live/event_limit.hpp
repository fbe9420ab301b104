// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace kelpie::live {

/// Keeps events readable while others cause events without end: Tuning::most_events of a kind in a
/// minute pass, the rest is counted. The kind of an event is the text before the first quote of
/// others, without digits.
class EventLimit {
 public:
  using Time = std::chrono::steady_clock::time_point;

  bool passes(const std::string& event, Time now);

  /// "12 more events in a minute, the last: …" for each kind whose minute has ended.
  std::vector<std::string> left_out(Time now);

 private:
  struct Minute {
    Time began;
    std::size_t events = 0;
    std::string last{};
  };
  std::map<std::string, Minute> minutes_;  // by kind
};

}  // namespace kelpie::live
