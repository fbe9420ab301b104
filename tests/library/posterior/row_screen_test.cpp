// SPDX-License-Identifier: Apache-2.0
#include "posterior/row_screen.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kelpie/core/random.hpp"
#include "posterior/features.hpp"
#include "posterior/posterior.hpp"
#include "posterior/recent_rows.hpp"

namespace kelpie::row_screen_test {
namespace {

constexpr std::size_t kTerms = 3;  // 1, u, c
const std::vector<std::string> kInputs{"u", "c"};

// y = 2 u − c and noise.
struct Stream {
  Features features{2, TermSet::from("u; c", kInputs, 1), std::vector<std::size_t>{0}, 10};
  Posterior live{kTerms, kTerms};
  RowScreen screen{2, kTerms};
  RandomStream random{7, "rows"};
  std::vector<double> learned_s{};
  double t = 0.0;

  // Adds a row with an error, and a command if any; what is due is learned.
  void add(double error, double seconds = 0.25, std::optional<double> command = {}) {
    const std::array<double, 2> x{random.normal(), command.value_or(random.normal())};
    std::array<double, kTerms> phi{};
    features.first(x, phi);
    const double y = 2.0 * x[0] - x[1] + 0.1 * random.normal() + error;
    screen.add({.x = x, .y = y, .left = y, .t = t}, features, phi, live);
    while (const auto due = screen.next()) {
      features.first(due->row.x, phi);
      live.add(phi, due->row.left, 1.0, due->likelihood);
      learned_s.push_back(due->row.t);
    }
    if (live.wants_solve()) {
      settle(live, features.groups());
    }
    t += seconds;
  }
};

TEST(RowScreen, LearnsRowsInTheirOrderAndEachOnce) {
  Stream stream;
  for (int i = 0; i < 400; ++i) {
    stream.add(0.0);
  }
  ASSERT_EQ(stream.learned_s.size(), 400U);
  for (std::size_t i = 0; i < 400; ++i) {
    EXPECT_EQ(stream.learned_s[i], 0.25 * static_cast<double>(i));
  }
}

TEST(RowScreen, DropsRowsThatContradict) {
  Stream stream;
  for (int i = 0; i < 400; ++i) {
    stream.add(0.0);
  }
  std::int64_t dropped = 0;
  for (int i = 0; i < 40; ++i) {
    stream.add(i < 20 ? 5.0 : 0.0);
    dropped += stream.screen.dropped();
    EXPECT_EQ(stream.screen.last_waits(), i < 20) << i;
  }
  EXPECT_EQ(dropped, 20);
  EXPECT_EQ(stream.learned_s.size(), 420U);
}

// A single outlier changes nothing known, and counts little.
TEST(RowScreen, LearnsALoneOutlierByItsError) {
  Stream stream;
  for (int i = 0; i < 2000; ++i) {
    stream.add(i == 1500 ? 1.0 : 0.0);
  }
  EXPECT_EQ(stream.learned_s.size(), 2000U);
  EXPECT_NEAR(stream.live.weights()[1], 2.0, 0.01);
}

// The command does the opposite, five times as much.
TEST(RowScreen, TakesUpWhatNeverEnds) {
  Stream stream;
  for (int i = 0; i < 400; ++i) {
    stream.add(0.0);
  }
  bool won = false;
  for (int i = 0; i < 160 && !won; ++i) {
    const double command = (i % 2 == 0 ? 1.0 : -1.0) + 0.1 * stream.random.normal();
    stream.add(6.0 * command, 0.25, command);
    won = stream.screen.won().has_value();
  }
  ASSERT_TRUE(won);
  EXPECT_TRUE(stream.screen.won()->is_change);
  EXPECT_DOUBLE_EQ(stream.screen.won()->since_s, 100.0);
  EXPECT_EQ(stream.learned_s.size(), 400U + static_cast<std::size_t>((stream.t - 100.0) / 0.25));
}

TEST(RowScreen, AnOffsetIsLearnedWithoutForgetting) {
  Stream stream;
  for (int i = 0; i < 400; ++i) {
    stream.add(0.0);
  }
  for (int i = 0; i < 400; ++i) {
    stream.add(5.0);
    EXPECT_FALSE(stream.screen.won()) << i;
    EXPECT_EQ(stream.screen.dropped(), 0) << i;
  }
  EXPECT_EQ(stream.learned_s.size(), 800U);
}

// A thruster runs for the first time, and the model is far off: the restart is better for longer
// than garbage lasts, yet tells nothing against what was known.
TEST(RowScreen, TakesUpANewPlaceWithoutForgetting) {
  Stream stream;
  for (int i = 0; i < 600; ++i) {
    stream.add(0.0, 0.25, 0.0);
  }
  for (int i = 0; i < 200; ++i) {
    const double command = 2.0 + 0.1 * (i % 5);
    stream.add(3.0 * command, 0.25, command);
    EXPECT_FALSE(stream.screen.won()) << i;
    EXPECT_EQ(stream.screen.dropped(), 0) << i;
  }
  EXPECT_EQ(stream.learned_s.size(), 800U);
  EXPECT_NEAR(value(stream.live, std::array{1.0, 1.0, 0.0}), 2.0, 0.2);
}

TEST(RecentRows, KeepTheLastRowsOfAFullRing) {
  RecentRows rows(1, 4);
  for (int i = 0; i < 7; ++i) {
    const std::array<double, 1> x{10.0 * i};
    rows.push({.x = x, .y = 1.0 * i, .left = 2.0 * i, .t = 3.0 * i}, RecentRows::State::due);
  }
  EXPECT_EQ(rows.begin(), 3U);
  EXPECT_EQ(rows.end(), 7U);
  for (std::size_t i = 3; i < 7; ++i) {
    const auto number = static_cast<double>(i);
    EXPECT_EQ(rows[i].x[0], 10.0 * number);
    EXPECT_EQ(rows[i].y, number);
    EXPECT_EQ(rows[i].left, 2.0 * number);
    EXPECT_EQ(rows[i].t, 3.0 * number);
  }
}

}  // namespace
}  // namespace kelpie::row_screen_test
