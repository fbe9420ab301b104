// SPDX-License-Identifier: Apache-2.0
#include "kelpie/stream/signal_history.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::signal_history_test {
namespace {

using Values = std::vector<double>;

const double kNaN = std::nan("");

SignalHistory history_of(const Values& stamps, const Values& values, std::size_t keep = 100) {
  SignalHistory history(keep, 0.0, 1.0);
  for (std::size_t k = 0; k < stamps.size(); ++k) {
    history.add(stamps[k], values[k]);
  }
  return history;
}

Values times_of(const SignalHistory& history) {
  Values times;
  for (std::size_t i = 0; i < history.size(); ++i) {
    times.push_back(history.time_s(i));
  }
  return times;
}

Values at(const SignalHistory& history, const Values& times, Interpolation between) {
  Values values;
  for (const double t : times) {
    values.push_back(history.at(t, between));
  }
  return values;
}

TEST(SignalHistory, PutsSamplesInOrderAndLeavesOutWhatHasNoValueOrStamp) {
  const SignalHistory history =
      history_of({0.0, 0.2, 0.1, 0.3, 0.3, 0.4, 2.0}, {0, 2, 1, 3, 9, kNaN, 7});
  EXPECT_EQ(times_of(history), (Values{0.0, 0.1, 0.2, 0.3, 2.0}));
  EXPECT_EQ(at(history, times_of(history), Interpolation::line), (Values{0, 1, 2, 3, 7}));
  const SignalFaults& faults = history.faults();
  EXPECT_EQ(faults.samples, 5U);
  EXPECT_EQ(faults.steps_back, 1U);
  EXPECT_EQ(faults.duplicates, 1U);
  EXPECT_EQ(faults.no_value, 1U);
  EXPECT_EQ(faults.gaps, 1U);
  EXPECT_DOUBLE_EQ(faults.longest_gap_s, 1.7);
  EXPECT_DOUBLE_EQ(faults.longest_gap_at_s, 0.3);
  EXPECT_EQ(faults.stuck, 0U);
}

TEST(SignalHistory, AStuckSensorIsFoundAndAnEqualPairAcrossASilenceIsNone) {
  Values stamps;
  Values values;
  for (int k = 0; k < 100; ++k) {
    stamps.push_back(0.1 * k);
    values.push_back(k >= 40 && k <= 60 ? 5.0 : 0.1 * k);
  }
  const auto until = [&](std::size_t count) {
    return history_of(Values(stamps.begin(), stamps.begin() + static_cast<std::ptrdiff_t>(count)),
                      Values(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count)));
  };
  EXPECT_FALSE(until(45).is_stuck());  // not for longer than the gap yet
  EXPECT_TRUE(until(60).is_stuck());
  EXPECT_FALSE(until(62).is_stuck());
  for (const std::size_t count : {60U, 62U, 100U}) {  // it is remembered when it is over
    EXPECT_TRUE(until(count).was_stuck(3.9, 4.1));
    EXPECT_FALSE(until(count).was_stuck(3.0, 3.95));
    EXPECT_TRUE(until(count).was_stuck(5.85, 8.0));
    EXPECT_FALSE(until(count).was_stuck(6.05, 8.0));
  }
  EXPECT_FALSE(until(45).was_stuck(4.2, 4.3));
  const SignalFaults faults = history_of(stamps, values).faults();
  EXPECT_EQ(faults.stuck, 1U);
  EXPECT_NEAR(faults.longest_stuck_s, 2.0, 1e-9);
  EXPECT_NEAR(faults.longest_stuck_at_s, 4.0, 1e-9);
  EXPECT_EQ(faults.samples, 100U);  // reported, not taken away: rest looks the same
  EXPECT_EQ(history_of({0.0, 9.0}, {1.0, 1.0}).faults().stuck, 0U);
}

TEST(SignalHistory, StatesLieOnLinesAndCommandsHold) {
  const SignalHistory history = history_of({0.0, 0.5, 1.0}, {0.0, 1.0, -1.0});
  const Values times{-0.1, 0.0, 0.25, 0.5, 0.75, 1.0, 1.3};
  const Values line = at(history, times, Interpolation::line);
  const Values hold = at(history, times, Interpolation::hold);
  EXPECT_TRUE(std::isnan(line[0]) && std::isnan(hold[0]) && std::isnan(line[6]));
  EXPECT_EQ(Values(line.begin() + 1, line.end() - 1), (Values{0.0, 0.5, 1.0, 0.0, -1.0}));
  EXPECT_EQ(Values(hold.begin() + 1, hold.end()), (Values{0.0, 0.0, 1.0, 1.0, -1.0, -1.0}));
}

// Samples of a wave of 1 Hz at 8 Hz: lines cut its crests.
TEST(SignalHistory, ACurveKeepsTheCrestsThatLinesCut) {
  const auto wave = [](double t) { return std::sin(6.283185307179586 * t); };
  Values stamps;
  Values values;
  for (int i = 0; i < 40; ++i) {
    stamps.push_back(0.125 * i + (i % 3 == 0 ? 0.01 : 0.0));
    values.push_back(wave(stamps.back()));
  }
  const SignalHistory history = history_of(stamps, values);
  double line = 0.0;
  double curve = 0.0;
  for (double t = 0.5; t < 4.5; t += 0.01) {
    line = std::fmax(line, std::abs(history.at(t, Interpolation::line) - wave(t)));
    curve = std::fmax(curve, std::abs(history.at(t, Interpolation::curve) - wave(t)));
  }
  EXPECT_LT(curve, 0.4 * line);
  EXPECT_EQ(at(history, stamps, Interpolation::curve), values);
}

TEST(SignalHistory, BesideASilenceACurveIsALine) {
  const SignalHistory history = history_of({0.0, 0.5, 2.0, 2.5}, {0, 4, 9, 1});
  for (const double t : {0.1, 0.3, 2.2, 2.4}) {
    EXPECT_DOUBLE_EQ(history.at(t, Interpolation::curve), history.at(t, Interpolation::line));
  }
  EXPECT_TRUE(std::isnan(history.at(1.0, Interpolation::curve)));
}

TEST(SignalHistory, NothingBridgesASilence) {
  const SignalHistory history = history_of({0.0, 0.5, 3.0, 3.5}, {0, 1, 2, 3});
  const Values times{0.25, 0.75, 1.5, 1.6, 2.9, 3.0, 3.25};
  const Values line = at(history, times, Interpolation::line);
  const Values hold = at(history, times, Interpolation::hold);
  for (const std::size_t k : {1U, 2U, 3U, 4U}) {
    EXPECT_TRUE(std::isnan(line[k])) << times[k];
  }
  EXPECT_EQ(line[5], 2.0);
  EXPECT_EQ(hold[2], 1.0);  // one second after its sample a held value is just still good
  EXPECT_TRUE(std::isnan(hold[3]) && std::isnan(hold[4]));
}

TEST(SignalHistory, KeepsTheLastSamplesInOrderWhereverTheRingBegins) {
  SignalHistory history = history_of({0, 1, 2, 4, 5, 7}, {0, 1, 2, 4, 5, 7}, 4);
  EXPECT_EQ(times_of(history), (Values{2, 4, 5, 7}));
  EXPECT_EQ(history.add(3, 3), SignalVerdict::used);
  EXPECT_EQ(times_of(history), (Values{3, 4, 5, 7}));
  EXPECT_EQ(history.add(6, 6), SignalVerdict::used);
  EXPECT_EQ(times_of(history), (Values{4, 5, 6, 7}));
  EXPECT_EQ(history.at(6.5, Interpolation::line), 6.5);
  EXPECT_EQ(history.add(1, 1), SignalVerdict::late);  // nothing is kept that old
  EXPECT_EQ(history.begin_s(), 0.0);
}

TEST(SignalHistory, WhatComesAfterItsUseIsLate) {
  SignalHistory history = history_of({0, 1}, {0, 1});
  history.close(0.7);
  EXPECT_EQ(history.add(0.6, 9), SignalVerdict::late);
  EXPECT_EQ(history.add(0.8, 0.8), SignalVerdict::used);
  EXPECT_EQ(history.faults().late, 1U);
  EXPECT_EQ(history.faults().steps_back, 1U);
}

TEST(SignalHistory, ALagMovesTheTimesAndNotTheStamps) {
  SignalHistory history(10, 0.25, 1.0);
  history.add(1.0, 3.0);
  EXPECT_EQ(history.at(0.75, Interpolation::hold), 3.0);
  EXPECT_EQ(history.newest_stamp_s(), 1.0);
}

TEST(SignalHistory, HasToKeepSomething) {
  EXPECT_EQ(testing::message_of<InputError>([] { SignalHistory(0, 0.0, 1.0); }),
            "keep: has to be one sample or more");
}

}  // namespace
}  // namespace kelpie::signal_history_test
