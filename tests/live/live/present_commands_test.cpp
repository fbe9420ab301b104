// SPDX-License-Identifier: Apache-2.0
#include "live/present_commands.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "kelpie/core/random.hpp"

namespace kelpie::present_commands_test {
namespace {

constexpr double kRateHz = 10.0;

std::shared_ptr<const Alignment> some_actuators() {
  return std::make_shared<const Alignment>(Alignment{
      .lag_s = 0.3,
      .rows = 3,
      .commands = {"n", "m"},
      .actuators = {{.neutral = 1.0, .lag_s = 0.6, .delay_s = 0.25}, {.dead_band = 0.5}}});
}

live::PresentCommands present() {
  return live::PresentCommands({"u", "n", "m"}, kRateHz, 1.0);
}

TEST(PresentCommands, AtTheTimesOfRowsAreThoseThatAreLearned) {
  const auto alignment = some_actuators();
  live::PresentCommands commands = present();
  commands.use(alignment);
  EXPECT_EQ(std::vector(commands.shifts_s().begin(), commands.shifts_s().end()),
            (std::vector{0.0, 0.3, 0.3}));
  AlignedRows rows(0, {1, 2}, 3, 0, kRateHz, alignment->actuators);
  RandomStream random(1, "commands");
  for (int row = 0; row < 200; ++row) {
    const double t = 0.1 * row;
    std::array<double, 3> x{random.normal(), random.normal(), random.normal()};
    rows.push(x, {}, t, [&](std::span<const double> expected, std::span<const double>, double) {
      commands.use(alignment);
      commands.act(x, t);
      EXPECT_EQ(std::vector(x.begin(), x.end()), std::vector(expected.begin(), expected.end()));
    });
  }
}

// A step of the command, with messages at a hundred times the rate of rows.
TEST(PresentCommands, BetweenRowsFollowTheCommandAtAnyRate) {
  live::PresentCommands commands = present();
  commands.use(some_actuators());
  for (int k = 0; k < 4000; ++k) {
    const double t = 1e-3 * k;
    std::array<double, 3> x{7.0, t < 1.0 ? 1.0 : 3.0, t < 1.0 ? 0.2 : 2.0};
    commands.act(x, t);
    const double since_s = t - 1.25;
    EXPECT_EQ(x[0], 7.0);
    EXPECT_NEAR(x[1], since_s > 0.0 ? 2.0 * (1.0 - std::exp(-since_s / 0.6)) : 0.0, 0.15) << t;
    EXPECT_EQ(x[2], t < 1.0 ? 0.0 : 1.5);
  }
}

TEST(PresentCommands, AfterASilenceOrUnderAnotherAlignmentBeginAtRest) {
  const auto alignment = some_actuators();
  live::PresentCommands commands = present();
  const auto effect = [&](double command, double t) {
    std::array<double, 3> x{0.0, command, 0.0};
    commands.act(x, t);
    return x[1];
  };
  commands.use(alignment);
  EXPECT_EQ(effect(1.0, 0.0), 0.0);
  EXPECT_EQ(effect(5.0, 0.1), 0.0);
  EXPECT_EQ(effect(5.0, 0.05), 0.0);  // steps back a little
  EXPECT_EQ(effect(5.0, 2.0), 4.0);
  EXPECT_LT(effect(1.0, 2.9), 4.0);
  EXPECT_EQ(effect(3.0, -100.0), 2.0);  // the clock was set
  commands.use(std::make_shared<const Alignment>(*alignment));
  EXPECT_EQ(effect(2.0, -99.9), 1.0);
  commands.use(std::make_shared<const Alignment>());
  EXPECT_EQ(effect(2.0, -99.8), 2.0);
  EXPECT_EQ(commands.shifts_s()[1], 0.0);
}

}  // namespace
}  // namespace kelpie::present_commands_test
