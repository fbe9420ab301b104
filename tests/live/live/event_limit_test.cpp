// SPDX-License-Identifier: Apache-2.0
#include "live/event_limit.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "live/outputs.hpp"
#include "live/tuning.hpp"

namespace kelpie::event_limit_test {
namespace {

using Lines = std::vector<std::string>;
using live::EventLimit;

struct Told final : live::Output {
  void event(const std::string& line) override { lines.push_back(line); }
  Lines lines;
};

// Publishers that come and go 40 times a second, each in a partition of its own.
TEST(EventLimit, EventsOfAKindAreFewInAMinuteAndTheRestIsCounted) {
  live::Outputs outputs;
  Told told;
  outputs.add(told);
  const auto partition = [](int k) {
    return "/odom: a publisher is in partition 'p" + std::to_string(k) + "', not ''";
  };
  for (int k = 0; k < 800; ++k) {
    outputs.event(partition(k));
    outputs.event("no more: " + partition(k));
  }
  outputs.event("a model is in service, after 40 samples");
  const std::size_t most = live::kTuning.most_events;
  ASSERT_EQ(told.lines.size(), 2 * most + 1);
  EXPECT_EQ(told.lines.back(), "a model is in service, after 40 samples");
  told.lines.clear();
  outputs.tell_left_out(EventLimit::Time::max());
  EXPECT_EQ(told.lines,
            (Lines{"790 more events in a minute, the last: " + partition(799),
                   "790 more events in a minute, the last: no more: " + partition(799)}));
}

TEST(EventLimit, AMinuteLaterEventsPassAgainAndKindsAreBounded) {
  EventLimit limit;
  const EventLimit::Time begin{};
  std::size_t passed = 0;
  for (int second = 0; second < 180; ++second) {
    const EventLimit::Time now = begin + std::chrono::seconds(second);
    limit.left_out(now);
    passed += limit.passes("at " + std::to_string(second) + " s: a boot", now) ? 1 : 0;
  }
  EXPECT_EQ(passed, 3 * live::kTuning.most_events);
  passed = 0;
  for (std::size_t k = 0; k < 10 * live::kTuning.most_event_kinds; ++k) {
    passed += limit.passes(std::string(k, 'a'), begin) ? 1 : 0;
  }
  EXPECT_LE(passed, live::kTuning.most_event_kinds + live::kTuning.most_events);
}

}  // namespace
}  // namespace kelpie::event_limit_test
