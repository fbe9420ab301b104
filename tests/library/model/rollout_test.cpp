// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/rollout.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "allocation_count.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "support.hpp"

namespace kelpie::rollout_test {
namespace {

using testing::message_of;

// ν' = rate ν + command, of which everything is known in closed form.
OpenLoop linear(double rate, double off = 0.0) {
  OpenLoop loop;
  loop.accelerations = [rate](std::span<const double> x, std::span<double> a) {
    a[0] = rate * x[0] + x[1];
  };
  loop.states = {0};
  loop.error = {0.0};
  loop.error_time_s = {0.0};
  loop.noise = {0.0};
  loop.off = {{off, off, off, off}};
  loop.seen = {{-2.0, 2.0}, {-1.0, 1.0}};
  return loop;
}

double after_ten_seconds(double step_s) {
  Rollout rollout(linear(-0.5), {.step_s = step_s, .between = CommandPath::linear, .measured = {}});
  rollout.start(std::array{1.0, 0.0});
  rollout.advance(std::array{0.0, 0.0}, 10.0);
  return rollout.velocity(0);
}

TEST(Rollout, IsOfFourthOrder) {
  const double truth = std::exp(-5.0);
  const double coarse = std::abs(after_ten_seconds(0.5) - truth);
  const double fine = std::abs(after_ten_seconds(0.25) - truth);
  EXPECT_NEAR(coarse / fine, 16.0, 3.0);
  EXPECT_LT(fine, 1e-6);
}

TEST(Rollout, HoldsCommandsOrGoesAlongALine) {
  // ν' = command, from 0 to 1 within a second: 0 where it is held till then, ½ along the line.
  for (const auto& [between, expected] :
       {std::pair{CommandPath::held, 0.0}, {CommandPath::linear, 0.5}}) {
    Rollout rollout(linear(0.0), {.between = between, .measured = {}});
    rollout.start(std::array{0.0, 0.0});
    rollout.advance(std::array{0.0, 1.0}, 1.0);
    EXPECT_NEAR(rollout.velocity(0), expected, 1e-12);
    rollout.advance(std::array{0.0, 1.0}, 0.5);
    EXPECT_NEAR(rollout.velocity(0), expected + 0.5, 1e-12);
    EXPECT_NEAR(rollout.age_s(), 1.5, 1e-12);
  }
}

TEST(Rollout, ANumberThatIsNoneIsToldUntilTheNextStart) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Rollout rollout(linear(-0.5, 0.1));
  rollout.start(std::array{1.0, 0.0});
  rollout.advance(std::array{0.0, nan}, 1.0);
  EXPECT_TRUE(rollout.beyond());
  rollout.advance(std::array{0.0, 0.5}, 1.0);
  EXPECT_TRUE(std::isnan(rollout.velocity(0)));
  EXPECT_TRUE(rollout.beyond());
  rollout.start(std::array{1.0, 0.5});
  rollout.advance(std::array{0.0, 0.5}, 1.0);
  EXPECT_NEAR(rollout.velocity(0), 1.0, 1e-9);
  EXPECT_FALSE(rollout.beyond());
}

TEST(Rollout, StandsStillWhereTimeStepsBackAndRefusesWhatIsNoStep) {
  Rollout rollout(linear(-0.5));
  rollout.start(std::array{1.0, 0.0});
  rollout.advance(std::array{0.0, 0.5}, -3.0);
  EXPECT_EQ(rollout.velocity(0), 1.0);
  EXPECT_EQ(rollout.age_s(), 0.0);
  for (const double dt_s :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e9}) {
    EXPECT_EQ(message_of<InputError>([&] {
                rollout.advance(std::array{0.0, 0.5}, dt_s);
              }),
              "dt_s: has to be finite, and at most a million steps of the integrator");
  }
  EXPECT_EQ(message_of<InputError>([&] { rollout.advance(std::array{0.0}, 1.0); }),
            "x: has 1 values; it has to have 2");
  EXPECT_THROW(rollout.start(std::array{0.0, 0.0, 0.0}), InputError);
  EXPECT_EQ(rollout.velocity(0), 1.0);
}

TEST(Rollout, TakesMeasuredStatesOverAndIntegratesTheOthers) {
  OpenLoop loop;
  loop.accelerations = [](std::span<const double> x, std::span<double> a) {
    a[0] = x[1];  // driven by the other state
    a[1] = 1e9;   // never asked for
  };
  loop.states = {0, 1};
  loop.error = {0.0, 1.0};
  loop.error_time_s = {0.0, 1.0};
  loop.noise = {0.0, 0.1};
  loop.seen = {{-10.0, 10.0}, {-1.0, 1.0}};
  Rollout rollout(loop, {.between = CommandPath::held, .measured = {1}});
  rollout.start(std::array{0.0, 0.0});
  rollout.advance(std::array{77.0, 1.0}, 1.0);
  EXPECT_NEAR(rollout.velocity(0), 0.5, 1e-12);
  EXPECT_EQ(rollout.velocity(1), 1.0);
  EXPECT_EQ(rollout.spread(1), 0.0);
  EXPECT_EQ(message_of<InputError>([&] { Rollout(loop, {.measured = {2}}); }),
            "measured: number 2; there are 2 velocities, counted from 0");
}

// Roll goes with the roll rate p, unless p is measured: then roll comes with the samples.
TEST(Rollout, RollIsIntegratedWhereOnlyOtherVelocitiesAreMeasured) {
  const std::vector<std::string> inputs{"u", "p", "phi"};
  const std::vector<std::size_t> states{0, 1};
  OpenLoop loop;
  loop.accelerations = [](std::span<const double>, std::span<double> a) { a[0] = a[1] = 0.0; };
  loop.states = states;
  loop.error = {0.0, 0.0};
  loop.error_time_s = {0.0, 0.0};
  loop.noise = {0.0, 0.0};
  loop.seen = {{-10.0, 10.0}, {-1.0, 1.0}, {-1.0, 1.0}};
  loop.attitude = AttitudeMotion(find_attitude(inputs, false), inputs, states);
  for (const auto& [measured, roll] : {std::pair{0, 0.3}, {1, 0.1}}) {
    double seen = 0.0;
    loop.accelerations = [&](std::span<const double> x, std::span<double> a) {
      a[0] = a[1] = 0.0;
      seen = x[2];
    };
    Rollout rollout(
        loop, {.between = CommandPath::held, .measured = {static_cast<std::size_t>(measured)}});
    rollout.start(std::array{1.0, 0.2, 0.1});
    rollout.advance(std::array{1.0, 0.2, 0.1}, 1.0);
    EXPECT_NEAR(seen, roll, 1e-9) << measured;
  }
}

TEST(Rollout, SpreadGoesFromTheNoiseToTheErrorsInPractice) {
  OpenLoop loop = linear(0.0);
  loop.noise = {0.1};
  loop.off = {{0.2, 0.4, 0.4, 0.8}};  // after 1, 4, 15 and 60 s
  Rollout rollout(loop);
  rollout.start(std::array{0.0, 0.0});
  EXPECT_DOUBLE_EQ(rollout.spread(0), 0.1);
  double age_s = 0.0;
  for (const auto& [look_s, expected] : {std::pair{0.5, 0.15},
                                         {1.0, 0.2},
                                         {2.0, 0.2 * std::sqrt(2.0)},
                                         {4.0, 0.4},
                                         {15.0, 0.4},
                                         {30.0, 0.4 * std::sqrt(2.0)},
                                         {60.0, 0.8},
                                         {240.0, 1.6}}) {
    rollout.advance(std::array{0.0, 0.0}, look_s - age_s);
    age_s = look_s;
    EXPECT_NEAR(rollout.spread(0), expected, 1e-9) << look_s;
  }
}

TEST(Rollout, KeepsTheVelocityWherePracticeSaysSo) {
  OpenLoop loop = linear(0.0);
  loop.kept = {{1.0, 0.5, 0.0, 0.0}};
  Rollout rollout(loop, {.between = CommandPath::held, .measured = {}});
  rollout.start(std::array{0.1, 0.02});  // 0.02 m/s per second
  rollout.advance(std::array{0.0, 0.02}, 1.0);
  EXPECT_NEAR(rollout.velocity(0), 0.12, 1e-9);
  rollout.advance(std::array{0.0, 0.02}, 3.0);
  EXPECT_NEAR(rollout.velocity(0), 0.1 + 0.5 * 0.08, 1e-9);
  rollout.advance(std::array{0.0, 0.02}, 26.0);
  EXPECT_NEAR(rollout.velocity(0), 0.1, 1e-9);
}

TEST(Rollout, StaysBoundedAndSaysThatItLeftKnownGround) {
  Rollout rollout(linear(+5.0, 100.0));  // explodes by itself
  rollout.start(std::array{0.1, 0.0});
  EXPECT_FALSE(rollout.beyond());
  bool beyond = false;
  for (int second = 0; second < 600; ++second) {
    rollout.advance(std::array{0.0, 0.0}, 1.0);
    ASSERT_LE(std::abs(rollout.velocity(0)), 4.0);  // the range seen is 4 wide, from −2 to 2
    ASSERT_LE(rollout.spread(0), 4.0 + 1e-9);
    beyond = beyond || rollout.beyond();
  }
  EXPECT_TRUE(beyond);
}

TEST(Rollout, ACommandNeverSeenIsBeyondKnownGround) {
  Rollout rollout(linear(-0.5));
  rollout.start(std::array{0.0, 1.09});
  EXPECT_FALSE(rollout.beyond());  // a twentieth of the range is let pass
  rollout.advance(std::array{0.0, 1.11}, 0.1);
  EXPECT_TRUE(rollout.beyond());
}

TEST(Rollout, AllocatesNothingOnItsWay) {
  KELPIE_NEEDS_ALLOCATION_COUNT();
  Rollout rollout(linear(-0.5, 0.1));
  rollout.start(std::array{0.5, 0.0});
  const std::array<double, 2> x{0.0, 0.3};
  const std::size_t before = testing::allocations;
  rollout.advance(x, 1.0);
  rollout.advance(x, 1.0);
  EXPECT_EQ(testing::allocations, before);
}

}  // namespace
}  // namespace kelpie::rollout_test
