// SPDX-License-Identifier: Apache-2.0
#include "live/health_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <string>

namespace kelpie::health_table_test {
namespace {

using live::Alert;
using live::AlertLevel;
using Lines = std::vector<std::string>;

live::Health well() {
  live::Health health;
  health.topics = {{.name = "/odom", .messages = 100}};
  health.sources = {{.name = "u", .from = "/odom:x", .rate_hz = 20.0, .faults = {}}};
  health.learner.axes = {{.name = "udot", .status = {.ready = true}}};
  return health;
}

template <typename Of>
void expect_whole() {
  std::set<std::string> metrics;
  for (const live::HealthField<Of>& field : live::health_fields<Of>()) {
    EXPECT_FALSE(field.help.empty());
    EXPECT_LE(field.names.brief.size(), 10U) << field.help;
    EXPECT_NE(field.get.number == nullptr, field.get.text == nullptr) << field.help;
    EXPECT_EQ(field.get.text != nullptr, field.kind == live::HealthKind::text) << field.help;
    if (!field.metric.empty()) {
      const std::string series(field.names.series.second);
      EXPECT_TRUE(metrics.insert(std::string(field.metric) + "_" + series).second) << field.metric;
    }
  }
}

TEST(HealthTable, EveryFieldIsWhole) {
  expect_whole<live::Health>();
  expect_whole<live::AxisHealth>();
  expect_whole<live::SourceHealth>();
  expect_whole<live::TopicHealth>();
  expect_whole<live::ThrusterHealth>();
}

TEST(HealthTable, WhatIsWellIsNoAlertAndNoEvent) {
  EXPECT_TRUE(live::alerts_of(well(), well()).empty());
  EXPECT_TRUE(live::events_of(well(), well()).empty());
}

TEST(HealthTable, ASignalIsSilentAfterItsGapEverywhere) {
  live::Health health = well();
  health.sources[0].gap_s = 3.0;
  health.sources[0].silent_s = 2.9;
  EXPECT_TRUE(live::alerts_of(health, well()).empty());
  health.sources[0].silent_s = 3.1;
  EXPECT_EQ(live::alerts_of(health, well()).at(0).text, "u is silent");
  EXPECT_EQ(live::events_of(health, well()), Lines{"u (/odom:x) is silent"});
  EXPECT_TRUE(live::events_of(health, health).empty());
  EXPECT_EQ(live::events_of(well(), health), Lines{"u (/odom:x) speaks"});
  health.sources[0].silent_s = std::numeric_limits<double>::infinity();
  EXPECT_EQ(live::alerts_of(health, well()).at(0).subject, "u");
}

TEST(HealthTable, GrowthIsAnAlertWhileItLastsAndOneEvent) {
  live::Health some = well();
  some.transport.lost = 2;
  live::Health more = some;
  more.transport.lost = 3;
  for (const auto& [now, before, events] :
       {std::tuple(some, well(), Lines{"messages are lost"}), std::tuple(more, some, Lines{})}) {
    EXPECT_EQ(live::alerts_of(now, before).at(0).text, "messages are lost");
    EXPECT_EQ(live::events_of(now, before), events);
  }
  EXPECT_TRUE(live::alerts_of(more, more).empty());
  some.clock_restarts = 1;
  more.clock_restarts = 2;  // each one counts
  EXPECT_EQ(live::events_of(more, some), Lines{"a clock was set back; samples begin anew"});
}

TEST(HealthTable, ErrorsComeFirstAndTextsSayWhy) {
  live::Health health = well();
  health.sources[0].is_stuck = true;
  health.topics[0].refused = "no such field";
  health.idle_s = 10.0;
  health.transport.faults = {"/odom: no publisher any more"};
  const std::vector<Alert> alerts = live::alerts_of(health, well());
  Lines texts;
  std::ranges::transform(alerts, std::back_inserter(texts), &Alert::text);
  EXPECT_EQ(texts, (Lines{"/odom cannot be used: no such field", "no messages come, for 10 s",
                          "/odom: no publisher any more", "u doesn't change any more"}));
  EXPECT_EQ(alerts[1].level, AlertLevel::error);
  EXPECT_EQ(alerts[2].level, AlertLevel::warn);
  EXPECT_EQ(live::events_of(health, well()),
            (Lines{"/odom cannot be used: no such field", "no messages come, for 10 s",
                   "/odom: no publisher any more"}));
  EXPECT_EQ(live::events_of(well(), health), Lines{"no more: /odom: no publisher any more"});
}

TEST(HealthTable, ADiskThatTakesNoMoreIsSaidUntilItDoes) {
  live::Health full = well();
  full.record_error = "rec/live_0001.mcap: No space left on device";
  full.learner.checkpoint_error = "Permission denied";
  const std::vector<Alert> alerts = live::alerts_of(full, well());
  ASSERT_EQ(alerts.size(), 2U);
  EXPECT_EQ(alerts[0].level, AlertLevel::error);
  EXPECT_EQ(alerts[0].text, "no checkpoint can be written: Permission denied");
  EXPECT_EQ(alerts[1].text, "nothing can be recorded: " + full.record_error);
  EXPECT_EQ(live::events_of(full, well()), Lines{alerts[1].text});
  EXPECT_TRUE(live::alerts_of(well(), full).empty());
  EXPECT_EQ(live::events_of(well(), full), Lines{"recording goes on"});
}

TEST(HealthTable, RowsInVainAreAnAlertAndTwoEvents) {
  live::Health health = well();
  health.no_rows = "no row has been whole for 10 s: u is silent";
  EXPECT_EQ(live::alerts_of(health, well()).at(0).text, health.no_rows);
  EXPECT_EQ(live::events_of(health, well()), Lines{health.no_rows});
  EXPECT_TRUE(live::events_of(health, health).empty());
  EXPECT_EQ(live::events_of(well(), health), Lines{"rows are whole again"});
}

TEST(HealthTable, AMessageOfAnotherTypeIsSaidOnceWithItsReason) {
  live::Health health = well();
  health.topics[0].undecodable = 1;
  health.topics[0].last_error = "too short";
  EXPECT_EQ(live::events_of(health, well()),
            Lines{"/odom has messages that aren't of its type: too short"});
  EXPECT_TRUE(live::events_of(health, health).empty());
}

}  // namespace
}  // namespace kelpie::health_table_test
