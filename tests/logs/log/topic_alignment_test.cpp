// SPDX-License-Identifier: Apache-2.0
#include "log/topic_alignment.hpp"

#include <gtest/gtest.h>

#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "log/signals.hpp"
#include "support.hpp"

namespace kelpie::topic_alignment_test {
namespace {

using testing::history_of;
using testing::signal_of;
using testing::Vehicle;

constexpr double kUntil = 60.0;

class Lag : public ::testing::Test {
 protected:
  // Two thrusters whose messages come late by so much.
  log::TopicAlignmentProblem problem(double port_late_s, double side_late_s) {
    port_ = history_of(signal_of("port", Vehicle::port, 25.0, -2.0, kUntil + 2.0, port_late_s));
    side_ = history_of(signal_of("side", Vehicle::side, 20.0, -2.0, kUntil + 2.0, side_late_s));
    log::TopicAlignmentProblem problem;
    problem.groups = {{"/port", {&port_}, Interpolation::line},
                      {"/side", {&side_}, Interpolation::line}};
    problem.responses.resize(2);
    problem.background.resize(2);
    for (int k = 20; k < 10.0 * kUntil; ++k) {
      const double t = 0.1 * k;
      problem.times_s.push_back(t);
      problem.responses[0].push_back(vehicle_.udot(t));
      problem.responses[1].push_back((vehicle_.v(t + 0.005) - vehicle_.v(t - 0.005)) / 0.01);
      problem.background[0].push_back(vehicle_.u(t));
      problem.background[1].push_back(vehicle_.v(t));
    }
    return problem;
  }

  Vehicle vehicle_{kUntil + 1.0};
  SignalHistory port_{1, 0.0, 1.0};
  SignalHistory side_{1, 0.0, 1.0};
};

TEST_F(Lag, AKnownShiftIsFoundLateAndEarly) {
  for (const double late_s : {0.3, -0.15}) {
    const log::TopicAlignment found = log::align_topics(problem(late_s, late_s));
    ASSERT_EQ(found.topics.size(), 2U);
    for (const log::TopicLag& topic : found.topics) {
      EXPECT_NEAR(topic.lag_s, late_s, 0.015);
      EXPECT_FALSE(topic.is_own);
    }
    EXPECT_GT(found.explained, 0.99);
    EXPECT_LT(found.explained_at_zero, found.explained - 0.02);
  }
}

TEST_F(Lag, ATopicFarFromTheOthersGetsItsOwn) {
  const log::TopicAlignment found = log::align_topics(problem(0.25, 0.0));
  EXPECT_TRUE(found.topics[0].is_own);
  EXPECT_NEAR(found.topics[0].lag_s, 0.25, 0.02);
  EXPECT_NEAR(found.topics[1].lag_s, 0.0, 0.1);
}

TEST_F(Lag, NoiseMovesItLittle) {
  log::TopicAlignmentProblem noisy = problem(0.2, 0.2);
  RandomStream random(5, "noise");
  for (auto& response : noisy.responses) {
    for (double& value : response) {
      value += 0.3 * random.normal();
    }
  }
  EXPECT_NEAR(log::align_topics(noisy).topics[0].lag_s, 0.2, 0.04);
}

TEST_F(Lag, RowsWithoutAllValuesHaveNoSay) {
  log::TopicAlignmentProblem holes = problem(0.3, 0.3);
  for (std::size_t row = 100; row < 200; ++row) {
    holes.responses[0][row] = std::nan("");
  }
  const log::TopicAlignment found = log::align_topics(holes);
  EXPECT_EQ(found.rows, holes.times_s.size() - 100);
  EXPECT_NEAR(found.topics[0].lag_s, 0.3, 0.015);
}

TEST_F(Lag, WhatCannotBeToldIsRefused) {
  log::TopicAlignmentProblem brief = problem(0.3, 0.3);
  brief.times_s.resize(40);
  EXPECT_NE(testing::message_of<InputError>([&] { log::align_topics(brief); }).find("lag: 40 rows"),
            std::string::npos);
  log::TopicAlignmentProblem too_late = problem(0.0, 0.0);
  const auto slow = [](double t) { return std::sin(0.3 * t); };
  port_ = side_ = history_of(signal_of("port", slow, 20.0, -4.0, kUntil + 4.0, 1.6));
  too_late.background.clear();
  for (std::size_t row = 0; row < too_late.times_s.size(); ++row) {
    const double n = slow(too_late.times_s[row]);
    too_late.responses[0][row] = too_late.responses[1][row] = n * std::abs(n);
  }
  EXPECT_NE(testing::message_of<InputError>([&] {
              log::align_topics(too_late);
            }).find("at the end of the range"),
            std::string::npos);
}

}  // namespace
}  // namespace kelpie::topic_alignment_test
