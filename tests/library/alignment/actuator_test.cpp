// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "allocation_count.hpp"
#include "kelpie/alignment/alignment.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"

namespace kelpie::actuator_test {
namespace {

double after_step(const Actuator& actuator, double rate_hz, double seconds) {
  ActuatorState state(actuator, rate_hz);
  state.next(0.0, 0.0);
  double value = 0.0;
  const int steps = static_cast<int>(std::lround(seconds * rate_hz));
  for (int i = 1; i <= steps; ++i) {
    value = state.next(1.0, i / rate_hz);
  }
  return value;
}

TEST(Actuator, DefaultChangesNothing) {
  ActuatorState state({}, 10.0);
  for (const double command : {0.0, -3.5, 1e9}) {
    EXPECT_EQ(state.next(command, 0.0), command);
  }
}

TEST(Actuator, ShapeHasANeutralPointADeadBandAndAGainAstern) {
  const Actuator pulses{.neutral = 1500.0, .dead_band = 25.0, .astern = 0.8};
  EXPECT_EQ(pulses.shaped(1500.0), 0.0);
  EXPECT_EQ(pulses.shaped(1520.0), 0.0);
  EXPECT_EQ(pulses.shaped(1480.0), 0.0);
  EXPECT_DOUBLE_EQ(pulses.shaped(1625.0), 100.0);
  EXPECT_DOUBLE_EQ(pulses.shaped(1375.0), -80.0);
}

// The commands change in a straight line over the first step, so the answer to a step at t = 0 is
// that to a ramp of one step: the difference vanishes with the square of the step.
TEST(Actuator, LagAnswersAsTheDifferentialEquationAtAnyRate) {
  for (const double rate_hz : {5.0, 20.0, 100.0}) {
    const double half_step = 0.5 / rate_hz;
    EXPECT_NEAR(after_step({.lag_s = 2.0}, rate_hz, 3.0), 1.0 - std::exp(-(3.0 - half_step) / 2.0),
                0.1 * half_step)
        << rate_hz;
  }
}

TEST(Actuator, RateLimitsTheSpeedOfChange) {
  EXPECT_NEAR(after_step({.rate = 0.25}, 10.0, 2.0), 0.5, 1e-12);
  EXPECT_NEAR(after_step({.rate = 0.25}, 10.0, 10.0), 1.0, 1e-12);
  EXPECT_NEAR(after_step({.lag_s = 0.5, .rate = 0.25}, 50.0, 1.0), 0.25, 1e-12);
}

TEST(Actuator, DelayIsInSecondsWhateverTheRate) {
  for (const double rate_hz : {3.0, 10.0, 40.0}) {
    EXPECT_EQ(after_step({.delay_s = 1.5}, rate_hz, 1.3), 0.0) << rate_hz;
    EXPECT_EQ(after_step({.delay_s = 1.5}, rate_hz, 2.4), 1.0) << rate_hz;
  }
}

TEST(Actuator, RestsAnewAfterAGap) {
  ActuatorState state({.lag_s = 5.0}, 10.0);
  state.next(0.0, 0.0);
  EXPECT_LT(state.next(1.0, 0.1), 0.02);
  state.rest();
  EXPECT_EQ(state.next(1.0, 90.0), 1.0);
}

TEST(Actuator, RefusesNumbersThatAreNone) {
  for (const Actuator& wrong :
       {Actuator{.neutral = NAN}, Actuator{.dead_band = -1.0}, Actuator{.astern = 0.0},
        Actuator{.lag_s = -0.1}, Actuator{.rate = INFINITY}, Actuator{.delay_s = 10.1}}) {
    EXPECT_THROW(ActuatorState(wrong, 10.0), InputError) << wrong.text();
  }
  EXPECT_THROW(ActuatorState({}, 0.0), InputError);
}

TEST(Actuator, TextTellsEveryPropertyOnce) {
  EXPECT_EQ(Actuator{}.text(), "acts at once");
  const Actuator all{1500.0, 25.0, 0.8, 0.9, 4.0, 0.2};
  for (const char* const number : {"1500", "25", "0.8", "0.9", "4 ", "0.2"}) {
    EXPECT_NE(all.text().find(number), std::string::npos) << number;
  }
  const Alignment alignment{.commands = {"a", "b", "c", "d"},
                            .actuators = {{.lag_s = 2.0}, {}, {.lag_s = 2.0}, {.dead_band = 3.0}}};
  EXPECT_EQ(alignment.text(),
            "a, c: follow their commands in 2 s; d: has no effect within 3 of rest");
  EXPECT_EQ((Actuator{.lag_s = 0.118921}).text(), "follows its command in 0.12 s");
  EXPECT_EQ((Actuator{.lag_s = 99.6}).text(), "follows its command in 100 s");
  const Alignment both{.commands = {"a", "b"}, .actuators = {all, all}};
  EXPECT_EQ(both.text(),
            "a, b: rest at 1500, have no effect within 25 of rest, give 0.8 times as much astern, "
            "follow their commands in 0.9 s, change by at most 4 per second, begin 0.2 s late");
}

TEST(Actuator, RowsPassThroughActuatorsWithoutAllocation) {
  KELPIE_NEEDS_ALLOCATION_COUNT();
  const std::vector<Actuator> actuators{{.neutral = 2.0, .lag_s = 0.7, .delay_s = 0.4}};
  AlignedRows rows(0, {1}, 2, 1, 10.0, actuators);
  ActuatorState alone(actuators.front(), 10.0);
  std::vector<double> x(2);
  const std::vector<double> y(1);
  std::size_t wrong = 0;
  const std::size_t before = testing::allocations;
  for (int i = 0; i < 200; ++i) {
    const double t = 0.1 * i + (i >= 100 ? 60.0 : 0.0);
    x = {1.0 * i, std::sin(0.3 * i)};
    if (i == 100) {
      alone.rest();
    }
    const double expected = alone.next(x[1], t);
    rows.push(x, y, t, [&](std::span<const double> given, auto, double) {
      wrong += given[0] == x[0] && given[1] == expected ? 0 : 1;
    });
  }
  EXPECT_EQ(testing::allocations, before);
  EXPECT_EQ(wrong, 0U);
}

TEST(Actuator, RowsNeedOneActuatorPerCommandOrNone) {
  const std::vector<Actuator> two(2);
  EXPECT_THROW(AlignedRows(0, {1}, 2, 1, 10.0, two), InputError);
}

// A craft of two velocities: a rotor n and a rudder d behind actuators, at `rate_hz`.
struct Drive {
  Drive(const Actuator& rotor, const Actuator& rudder, double rate_hz = 5.0, double minutes = 20.0)
      : rate(rate_hz) {
    RandomStream random(11, "drive");
    ActuatorState first(rotor, rate_hz);
    ActuatorState second(rudder, rate_hz);
    const double dt = 1.0 / rate_hz;
    double n = rotor.neutral;
    double d = rudder.neutral;
    double u = 0.0;
    double r = 0.0;
    double until_n = 0.0;
    double until_d = 0.0;
    for (double t = 0.0; t < 60.0 * minutes; t += dt) {
      if (t >= until_n) {
        n = rotor.neutral + random.uniform(-10.0, 10.0);
        until_n = t + random.uniform(2.0, 12.0);
      }
      if (t >= until_d) {
        d = rudder.neutral + random.uniform(-0.4, 0.4);
        until_d = t + random.uniform(2.0, 10.0);
      }
      const double a = first.next(n, t);
      const double b = second.next(d, t);
      const double udot = 0.01 * a * std::abs(a) - 0.5 * u * std::abs(u) - 0.05 * u;
      const double rdot = 0.3 * b * u + 0.1 * b - 0.4 * r - 0.8 * r * std::abs(r);
      inputs.insert(inputs.end(), {u, r, n, d});
      targets.insert(targets.end(),
                     {udot + 0.02 * random.normal(), rdot + 0.002 * random.normal()});
      times.push_back(t);
      u += dt * udot;
      r += dt * rdot;
    }
    rows.resize(times.size());
    std::iota(rows.begin(), rows.end(), std::size_t{0});
  }

  AlignmentResult found() const {
    return find_alignment({.inputs = inputs,
                           .targets = targets,
                           .times_s = times,
                           .configurations = {},
                           .rows = rows,
                           .input_names = {"u", "r", "n", "d"},
                           .target_count = 2,
                           .states = "u,r",
                           .rate_hz = rate});
  }

  double rate;
  std::vector<double> inputs;
  std::vector<double> targets;
  std::vector<double> times;
  std::vector<std::size_t> rows;
};

TEST(ActuatorSearch, FindsTimeConstantsOfEachCommandAtAnyRate) {
  for (const double rate_hz : {2.0, 10.0}) {
    const AlignmentResult found = Drive({.lag_s = 1.5}, {.lag_s = 4.0}, rate_hz).found();
    ASSERT_EQ(found.alignment.actuators.size(), 2U) << found.why;
    EXPECT_NEAR(found.alignment.actuators[0].lag_s, 1.5, 0.3) << rate_hz;
    EXPECT_NEAR(found.alignment.actuators[1].lag_s, 4.0, 0.8) << rate_hz;
    EXPECT_EQ(found.alignment.rows, 0);
    EXPECT_GT(found.gain, 0.3);
  }
}

TEST(ActuatorSearch, FindsARateLimit) {
  const AlignmentResult found = Drive({}, {.rate = 0.05}).found();
  ASSERT_EQ(found.alignment.actuators.size(), 2U) << found.why;
  EXPECT_EQ(found.alignment.actuators[0].lag_s, 0.0);
  EXPECT_NEAR(found.alignment.actuators[1].rate, 0.05, 0.01);
}

TEST(ActuatorSearch, FindsADelayOfOneCommand) {
  for (const double delay_s : {0.4, 0.8, 1.6}) {
    const AlignmentResult found = Drive({}, {.delay_s = delay_s}).found();
    ASSERT_EQ(found.alignment.actuators.size(), 2U) << found.why;
    EXPECT_TRUE(found.alignment.actuators[0].none());
    EXPECT_NEAR(found.alignment.actuators[1].delay_s, delay_s, 0.01);
    EXPECT_LE(found.alignment.actuators[1].lag_s, 0.1);
  }
}

TEST(ActuatorSearch, KnowsServoPulsesByTheirRange) {
  Drive drive({}, {});
  for (std::size_t row = 0; row < drive.rows.size(); ++row) {
    drive.inputs[4 * row + 2] = 1500.0 + 40.0 * drive.inputs[4 * row + 2];
  }
  const AlignmentResult found = drive.found();
  ASSERT_EQ(found.alignment.actuators.size(), 2U) << found.why;
  EXPECT_EQ(found.alignment.actuators[0], Actuator{.neutral = 1500.0});
  EXPECT_TRUE(found.alignment.actuators[1].none());
}

TEST(ActuatorSearch, WithoutEvidenceCommandsStandAsTheyAre) {
  const AlignmentResult prompt = Drive({}, {}).found();
  EXPECT_TRUE(prompt.alignment.none()) << prompt.alignment.text() << prompt.why;
  Drive still({.lag_s = 1.5}, {});  // a command that never moves
  for (std::size_t row = 0; row < still.rows.size(); ++row) {
    still.inputs[4 * row + 2] = 7.0;
    still.inputs[4 * row + 3] = 0.0;
  }
  EXPECT_TRUE(still.found().alignment.none());
}

// A lag as long as the drive can't be told from a constant force.
TEST(ActuatorSearch, NoLagIsLongerThanTheDriveCanTell) {
  const AlignmentResult found = Drive({.lag_s = 400.0}, {}, 5.0, 5.0).found();
  for (const Actuator& actuator : found.alignment.actuators) {
    EXPECT_LE(actuator.lag_s, 0.02 * 300.0 * 2.0) << found.alignment.text();
  }
}

}  // namespace
}  // namespace kelpie::actuator_test
