// SPDX-License-Identifier: Apache-2.0
#include "log/signal.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::signal_test {
namespace {

using Values = std::vector<double>;

const double kNaN = std::nan("");

log::Signal signal_of(const Values& times, const Values& values) {
  log::Signal signal;
  signal.from = "/a:x";
  signal.times_s = times;
  signal.values = values;
  return signal;
}

TEST(Signal, IsPutInOrderAndRidOfWhatHasNoValueOrStamp) {
  log::Signal signal = signal_of({0.0, 0.2, 0.1, 0.3, 0.3, 0.4, 2.0}, {0, 2, 1, 3, 9, kNaN, 7});
  log::sort_by_time(signal);
  const log::SignalFaults faults = log::tidy(signal, 1.0);
  EXPECT_EQ(signal.times_s, (Values{0.0, 0.1, 0.2, 0.3, 2.0}));
  EXPECT_EQ(signal.values, (Values{0, 1, 2, 3, 7}));
  EXPECT_EQ(faults.samples, 5U);
  EXPECT_EQ(faults.steps_back, 1U);
  EXPECT_EQ(faults.duplicates, 1U);
  EXPECT_EQ(faults.no_value, 1U);
  EXPECT_EQ(faults.gaps, 1U);
  EXPECT_DOUBLE_EQ(faults.longest_gap_s, 1.7);
  EXPECT_DOUBLE_EQ(faults.longest_gap_at_s, 0.3);
  EXPECT_EQ(faults.stuck, 0U);
}

TEST(Signal, AStuckSensorIsFoundAndAnEqualPairAcrossASilenceIsNone) {
  Values times;
  Values values;
  for (int k = 0; k < 100; ++k) {
    times.push_back(0.1 * k);
    values.push_back(k >= 40 && k <= 60 ? 5.0 : 0.1 * k);
  }
  log::Signal signal = signal_of(times, values);
  const log::SignalFaults faults = log::tidy(signal, 1.0);
  EXPECT_EQ(faults.stuck, 1U);
  EXPECT_NEAR(faults.longest_stuck_s, 2.0, 1e-9);
  EXPECT_NEAR(faults.longest_stuck_at_s, 4.0, 1e-9);
  EXPECT_EQ(signal.values.size(), 100U);  // reported, not taken away: rest looks the same
  log::Signal silent = signal_of({0.0, 9.0}, {1.0, 1.0});
  EXPECT_EQ(log::tidy(silent, 1.0).stuck, 0U);
}

TEST(Signal, AClockSetWithinTheLogIsRefusedWithItsJump) {
  log::Signal set = signal_of({0.0, 1.7e9, 1.7e9 + 0.25}, {1, 2, 3});
  EXPECT_EQ(
      testing::message_of<InputError>([&] { log::tidy(set, 1.0); }),
      "/a:x: its time jumps from 0.000 to 1700000000.000 s: was a clock set meanwhile, or are "
      "the stamps not in seconds?");
  log::Signal night = signal_of({0.0, 40'000.0}, {1, 2});
  EXPECT_EQ(log::tidy(night, 1.0).gaps, 1U);
}

TEST(Signal, AClockSetBackOrNoValueAtAllIsRefused) {
  log::Signal back = signal_of({100.0, 101.0, 3.0}, {1, 2, 3});
  log::sort_by_time(back);
  EXPECT_NE(testing::message_of<InputError>([&] { log::tidy(back, 1.0); })
                .find("/a:x: its time runs "
                      "back by 98.000 s"),
            std::string::npos);
  log::Signal empty = signal_of({0.0}, {kNaN});
  EXPECT_NE(testing::message_of<InputError>([&] { log::tidy(empty, 1.0); }), "");
}

TEST(Resampled, StatesLieOnLinesAndCommandsHold) {
  const log::Signal signal = signal_of({0.0, 0.5, 1.0}, {0.0, 1.0, -1.0});
  const Values at{-0.1, 0.0, 0.25, 0.5, 0.75, 1.0, 1.3};
  const Values line = log::resampled(signal, at, log::Between::line, 1.0);
  const Values hold = log::resampled(signal, at, log::Between::hold, 1.0);
  EXPECT_TRUE(std::isnan(line[0]) && std::isnan(hold[0]) && std::isnan(line[6]));
  EXPECT_EQ(Values(line.begin() + 1, line.end() - 1), (Values{0.0, 0.5, 1.0, 0.0, -1.0}));
  EXPECT_EQ(Values(hold.begin() + 1, hold.end()), (Values{0.0, 0.0, 1.0, 1.0, -1.0, -1.0}));
}

TEST(Resampled, NothingBridgesASilence) {
  const log::Signal signal = signal_of({0.0, 0.5, 3.0, 3.5}, {0, 1, 2, 3});
  const Values at{0.25, 0.75, 1.5, 1.6, 2.9, 3.0, 3.25};
  const Values line = log::resampled(signal, at, log::Between::line, 1.0);
  const Values hold = log::resampled(signal, at, log::Between::hold, 1.0);
  for (const std::size_t k : {1U, 2U, 3U, 4U}) {
    EXPECT_TRUE(std::isnan(line[k])) << at[k];
  }
  EXPECT_EQ(line[5], 2.0);
  EXPECT_EQ(hold[2], 1.0);  // one second after its sample a held value is just still good
  EXPECT_TRUE(std::isnan(hold[3]) && std::isnan(hold[4]));
}

}  // namespace
}  // namespace kelpie::signal_test
