// SPDX-License-Identifier: Apache-2.0
#include "kelpie/alignment/alignment.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "alignment/late_log.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "support.hpp"

namespace kelpie::alignment_search_test {
namespace {

using Log = testing::LateLog;
using Names = std::vector<std::string>;

TEST(AlignmentSearch, FindsHowLateCommandsWereLoggedWhateverTheNames) {
  for (const int late : {-7, -3, 0, 2, 5}) {
    const Log log(late);
    for (const Names& names : {Names{"u", "v", "n", "m"}, Names{"a", "b", "c", "d"}}) {
      const AlignmentResult found = find_alignment(log.problem(names));
      EXPECT_EQ(found.alignment.rows, late) << found.why;
      EXPECT_DOUBLE_EQ(found.alignment.lag_s, 0.1 * late);
      EXPECT_EQ(found.alignment.commands, Names(names.begin() + 2, names.end()));
      EXPECT_EQ(found.gain > 0.0, late != 0);
    }
  }
}

TEST(AlignmentSearch, NamesAloneTellCommandsWhereTheyTellVelocities) {
  const Log log(0);
  const Names named{"u", "v", "n", "m"};
  EXPECT_EQ(named_commands(named, 2, "auto"), find_commands(log.problem(named)));
  EXPECT_EQ(named_commands(Names{"a", "b", "c"}, 1, "b"), (std::vector<std::size_t>{0, 2}));
  EXPECT_TRUE(named_commands(Names{"a", "b", "c"}, 1, "auto").empty());
  EXPECT_EQ(named_commands(Names{"u", "pitch", "n", "yaw"}, 1, "auto"),
            std::vector<std::size_t>{2});  // an attitude has no actuator
}

// Before the one in use gives way another has to be clearly better; none is one of them.
TEST(AlignmentSearch, TheShiftInUseHasToBeBeaten) {
  const Log log(2);
  AlignmentProblem problem = log.problem();
  problem.current.rows = 2;
  EXPECT_EQ(find_alignment(problem).why, "no shift and no actuator explains more");
  for (const int in_use : {-4, 5}) {
    problem.current.rows = in_use;
    EXPECT_EQ(find_alignment(problem).alignment.rows, 2);
    const Log as_sent(0);
    AlignmentProblem unshifted = as_sent.problem();
    unshifted.current.rows = in_use;
    EXPECT_TRUE(find_alignment(unshifted).alignment.none());
  }
  const Log few(2, 90);
  problem = few.problem();
  problem.current.rows = 5;
  EXPECT_EQ(find_alignment(problem).alignment.rows, 5);
}

TEST(AlignmentSearch, CommandsThatMoveNothingAreNotShifted) {
  RandomStream random(3, "noise");
  for (int trial = 0; trial < 5; ++trial) {
    Log log(0, 600);
    for (std::size_t row = 0; row < log.rows.size(); ++row) {
      log.inputs[4 * row + 2] = random.normal();
      log.inputs[4 * row + 3] = random.normal();
      log.targets[2 * row] = random.normal();
      log.targets[2 * row + 1] = random.normal();
    }
    const AlignmentResult found = find_alignment(log.problem());
    EXPECT_TRUE(found.alignment.none()) << found.why;
    EXPECT_EQ(found.gain, 0.0);
  }
}

TEST(AlignmentSearch, LooksAtNothingButTheRowsItIsGiven) {
  Log log(4);
  std::erase_if(log.rows, [](std::size_t row) { return row % 400 >= 300; });
  const AlignmentResult before = find_alignment(log.problem());
  for (std::size_t row = 0; row < log.times.size(); ++row) {
    if (row % 400 >= 300) {
      std::fill_n(log.inputs.begin() + static_cast<std::ptrdiff_t>(4 * row), 4, 1e6);
      std::fill_n(log.targets.begin() + static_cast<std::ptrdiff_t>(2 * row), 2, -1e6);
    }
  }
  const AlignmentResult after = find_alignment(log.problem());
  EXPECT_EQ(before.alignment.rows, 4) << before.why;
  EXPECT_EQ(after.alignment.rows, 4);
  EXPECT_EQ(after.gain, before.gain);
}

TEST(AlignmentSearch, AbsurdRowsDecideNothing) {
  Log log(4);
  log.targets[std::size_t{2} * 777] = 1e300;
  log.inputs[std::size_t{4} * 900] = -999.0;
  log.inputs[std::size_t{4} * 1200 + 2] = 1e200;
  EXPECT_EQ(find_alignment(log.problem()).alignment.rows, 4);
}

// As where the velocity log lost the ground, for one stretch of 4 % of the log.
TEST(AlignmentSearch, AStretchOfWildVelocitiesDecidesNothing) {
  for (const std::size_t from : {std::size_t{300}, std::size_t{1850}}) {
    for (const int late : {0, 4}) {
      Log log(late);
      const AlignmentResult clean = find_alignment(log.problem());
      RandomStream random(5, "wild");
      for (std::size_t row = from; row < from + 80; ++row) {
        for (std::size_t axis = 0; axis < 2; ++axis) {
          log.inputs[4 * row + axis] = random.uniform(-8.0, 8.0);
          log.targets[2 * row + axis] = random.uniform(-80.0, 80.0);
        }
      }
      const AlignmentResult found = find_alignment(log.problem());
      EXPECT_EQ(found.alignment.rows, late) << found.why;
      EXPECT_EQ(found.alignment.actuators, clean.alignment.actuators) << found.alignment.text();
    }
  }
}

TEST(AlignmentSearch, RowsBeyondAGapAreNoNeighbours) {
  // Stretches of five rows: commands nine rows on, which would fit, are never of the same stretch.
  Log log(9);
  for (std::size_t row = 0; row < log.times.size(); ++row) {
    const std::size_t stretch = row / 5;
    log.times[row] += 100.0 * static_cast<double>(stretch);
  }
  EXPECT_LT(find_alignment(log.problem()).alignment.rows, 5);
  std::vector<int> configurations;
  const Log other(9);
  for (std::size_t row = 0; row < other.times.size(); ++row) {
    configurations.push_back(static_cast<int>(row / 5));
  }
  AlignmentProblem problem = other.problem();
  EXPECT_EQ(find_alignment(problem).alignment.rows, 9);
  problem.configurations = configurations;
  EXPECT_LT(find_alignment(problem).alignment.rows, 5);
}

TEST(AlignmentSearch, WhatIsKnownOfActuatorsStandsWhateverIsFound) {
  const Actuator pulses{.neutral = 1500.0, .dead_band = 0.01};
  for (const std::size_t size : {std::size_t{60}, std::size_t{2000}}) {
    Log log(3, size);
    for (std::size_t row = 0; row < log.rows.size(); ++row) {
      log.inputs[4 * row + 3] += 1500.0;
    }
    AlignmentProblem problem = log.problem();
    problem.known = {{"m", pulses}};
    const Alignment found = find_alignment(problem).alignment;
    ASSERT_EQ(found.actuators.size(), 2U);
    EXPECT_EQ(found.actuators[1], pulses);
    EXPECT_EQ(found.rows, size > 1000 ? 3 : 0);
  }
  const Log log(0);
  AlignmentProblem problem = log.problem();
  problem.known = {{"u", pulses}};
  EXPECT_EQ(testing::message_of<InputError>([&] { find_alignment(problem); }).substr(0, 3), "u: ");
}

// A constant force explains as much as a neutral point where thrust is linear in the pulse.
TEST(AlignmentSearch, PulsesRestAt1500WhereTheLogDoesNotTell) {
  RandomStream random(3, "pulses");
  testing::TwoAxisLog log;
  std::array<double, 2> v{};
  std::array<double, 2> pulse{1500.0, 1500.0};
  for (std::size_t i = 0; i < 2000; ++i) {
    for (double& p : pulse) {
      p = i % 20 == 0 ? random.uniform(1100.0, 1900.0) : p;
    }
    const std::array<double, 2> y{2e-3 * (pulse[0] - 1500.0) - 0.8 * v[0],
                                  1e-3 * (pulse[1] - 1500.0) - 0.5 * v[1]};
    log.add({v[0], v[1], pulse[0], pulse[1]},
            {y[0] + 0.05 * random.normal(), y[1] + 0.05 * random.normal()});
    for (std::size_t axis = 0; axis < 2; ++axis) {
      v[axis] += 0.1 * y[axis];
    }
  }
  const AlignmentResult found = find_alignment(log.problem());
  ASSERT_EQ(found.alignment.actuators.size(), 2U) << found.why;
  for (const Actuator& actuator : found.alignment.actuators) {
    EXPECT_EQ(actuator, Actuator{.neutral = 1500.0});
  }
}

TEST(AlignmentSearch, SaysWhyThereIsNone) {
  const auto reason = [](const AlignmentProblem& problem) { return find_alignment(problem).why; };
  const Log log(5);
  const Log few(5, 90);
  EXPECT_NE(reason(few.problem()).find("too few"), std::string::npos);
  AlignmentProblem problem = log.problem();
  problem.rate_hz = 0.1;
  EXPECT_NE(reason(problem).find("too far apart"), std::string::npos);
  problem = log.problem({"u", "v", "w", "p"});
  EXPECT_NE(reason(problem).find("no inputs are known"), std::string::npos);
}

TEST(AlignmentSearch, ConstantColumnsDoNoHarm) {
  Log log(3);
  for (std::size_t row = 0; row < log.rows.size(); ++row) {
    log.inputs[4 * row + 3] = 0.0;
  }
  EXPECT_EQ(find_alignment(log.problem()).alignment.rows, 3);
}

}  // namespace
}  // namespace kelpie::alignment_search_test
