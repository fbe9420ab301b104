// SPDX-License-Identifier: Apache-2.0
#include "kelpie/navigation/dead_reckoning.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "allocation_count.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "support.hpp"

namespace kelpie::dead_reckoning_test {
namespace {

using testing::message_of;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kStepS = 0.25;
constexpr double kDrag = 0.2;  // 1/s

// Of surge, sway, yaw rate and three commands: ν̇ = −drag ν + command, of which all is known.
OpenLoop linear_vehicle(double error = 0.01, double drag = kDrag, double surge_push = 0.0) {
  OpenLoop loop;
  loop.accelerations = [=](std::span<const double> x, std::span<double> a) {
    for (std::size_t i = 0; i < 3; ++i) {
      a[i] = -drag * x[i] + x[3 + i];
    }
    a[0] += surge_push;
  };
  loop.states = {0, 1, 2};
  loop.error = {error, error, 0.1 * error};
  loop.error_time_s = {2.0, 2.0, 2.0};
  loop.noise = {0.001, 0.001, 0.0005};
  loop.seen = {{-1.0, 1.0}, {-1.0, 1.0}, {-0.5, 0.5}, {-0.2, 0.2}, {-0.2, 0.2}, {-0.1, 0.1}};
  return loop;
}

// The same vehicle in a current, pushed about by a Gauss-Markov acceleration.
class Water {
 public:
  Water(std::array<double, 2> current, double push, std::uint64_t seed)
      : current_(current), push_(push), random_(seed, "water") {}

  void advance() {
    constexpr int kFine = 25;
    const double dt = kStepS / kFine;
    for (int k = 0; k < kFine; ++k) {
      const double t = time_s_ + k * dt;
      command_ = {0.06 + 0.04 * std::sin(0.11 * t), 0.03 * std::sin(0.07 * t),
                  0.02 * std::sin(0.05 * t)};
      const double c = std::cos(heading);
      const double s = std::sin(heading);
      const double ahead = c * current_[0] + s * current_[1];
      const double across = -s * current_[0] + c * current_[1];
      const double u = velocity[0];
      const double v = velocity[1];
      const double r = velocity[2];
      velocity[0] += dt * (-drag * (u - ahead) + command_[0] + pushed_[0] + r * across);
      velocity[1] += dt * (-drag * (v - across) + command_[1] + pushed_[1] - r * ahead);
      velocity[2] += dt * (-drag * r + command_[2]);
      position[0] += dt * (c * u - s * v);
      position[1] += dt * (s * u + c * v);
      heading += dt * r;
      for (double& push : pushed_) {
        push += -dt / 2.0 * push + push_ * std::sqrt(2.0 * dt / 2.0) * random_.normal();
      }
    }
    time_s_ += kStepS;
  }

  void set_current(const std::array<double, 2>& current) { current_ = current; }

  // As measured; silent: the yaw rate alone.
  std::array<double, 6> sample(bool silent) {
    const double u = velocity[0] + 0.001 * random_.normal();
    const double v = velocity[1] + 0.001 * random_.normal();
    return {silent ? kNaN : u, silent ? kNaN : v, velocity[2] + 0.0005 * random_.normal(),
            command_[0],       command_[1],       command_[2]};
  }

  double time_s() const { return time_s_; }

  std::array<double, 3> velocity{};
  std::array<double, 2> position{};
  double heading = 0.0;
  double drag = kDrag;

 private:
  std::array<double, 2> current_;
  double push_;
  RandomStream random_;
  std::array<double, 3> command_{};
  std::array<double, 2> pushed_{};
  double time_s_ = 0.0;
};

void follow(DeadReckoning& reckoning, Water& water, double seconds, bool silent) {
  for (int k = 0; k < static_cast<int>(seconds / kStepS); ++k) {
    water.advance();
    reckoning.update(water.sample(silent), water.time_s());
  }
}

// How far off it is after an outage of so many seconds.
double off_after(DeadReckoning reckoning, Water water, double seconds) {
  const std::array<double, 2> before = water.position;
  follow(reckoning, water, seconds, true);
  const Drift drift = reckoning.drift();
  return std::hypot(drift.position_m[0] - (water.position[0] - before[0]),
                    drift.position_m[1] - (water.position[1] - before[1]));
}

TEST(DeadReckoning, FindsTheCurrentAndCarriesItThroughAnOutage) {
  Water water({0.15, -0.1}, 0.0, 1);
  DeadReckoning reckoning(linear_vehicle(0.002));
  DeadReckoning without(linear_vehicle(0.002), {.current_m_s = 0.0});
  for (int k = 0; k < 2400; ++k) {
    water.advance();
    const std::array<double, 6> x = water.sample(false);
    reckoning.update(x, water.time_s());
    without.update(x, water.time_s());
  }
  EXPECT_NEAR(reckoning.current()[0], 0.15, 0.03);
  EXPECT_NEAR(reckoning.current()[1], -0.1, 0.03);
  EXPECT_EQ(without.current()[0], 0.0);
  EXPECT_LT(off_after(reckoning, water, 60.0), 0.8);
  EXPECT_GT(off_after(without, water, 60.0), 3.0);
}

// A model so exact that without a current hardly a measurement is believable: what doesn't know of
// the current still follows the velocities, and can't be preferred for want of being judged.
TEST(DeadReckoning, FindsACurrentThatNothingElseExplains) {
  Water water({0.25, -0.2}, 0.0, 6);
  DeadReckoning reckoning(linear_vehicle(0.0002));
  DeadReckoning without(linear_vehicle(0.0002), {.current_m_s = 0.0});
  for (int k = 0; k < 1200; ++k) {
    water.advance();
    const std::array<double, 6> x = water.sample(false);
    reckoning.update(x, water.time_s());
    without.update(x, water.time_s());
  }
  EXPECT_NEAR(reckoning.current()[0], 0.25, 0.01);
  EXPECT_NEAR(reckoning.current()[1], -0.2, 0.01);
  EXPECT_NEAR(without.velocity(0), water.velocity[0], 0.05);
  EXPECT_NEAR(without.velocity(1), water.velocity[1], 0.05);
  EXPECT_GT(without.noise_factor(), 5.0);
  EXPECT_LT(off_after(reckoning, water, 60.0), 0.3);
}

TEST(DeadReckoning, FollowsAVehicleThatReallyIsElsewhereWithinASecond) {
  Water water({0.0, 0.0}, 0.01, 7);
  DeadReckoning reckoning(linear_vehicle());
  follow(reckoning, water, 60.0, false);
  water.velocity[0] -= 0.5;
  follow(reckoning, water, 1.0, false);
  EXPECT_NEAR(reckoning.velocity(0), water.velocity[0], 0.01);
}

TEST(DeadReckoning, WithoutACurrentBelievesInNone) {
  Water water({0.0, 0.0}, 0.01, 2);
  DeadReckoning reckoning(linear_vehicle());
  const DeadReckoning without(linear_vehicle(), {.current_m_s = 0.0});
  double off = 0.0;
  double off_without = 0.0;
  for (int k = 0; k < 20; ++k) {
    follow(reckoning, water, 60.0, false);
    Water same = water;
    DeadReckoning fresh = without;
    follow(fresh, same, 5.0, false);
    off += off_after(reckoning, water, 30.0);
    off_without += off_after(fresh, same, 30.0);
  }
  EXPECT_LT(off, 1.3 * off_without);
}

// Nine in ten errors within the ellipse, though the model told half of what its errors are.
TEST(DeadReckoning, IsHonestEvenIfTheModelIsnt) {
  int inside = 0;
  int all = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    Water water({0.0, 0.0}, 0.01, seed);
    DeadReckoning reckoning(linear_vehicle(0.005));
    follow(reckoning, water, 1500.0, false);
    for (int k = 0; k < 25; ++k, ++all) {
      follow(reckoning, water, 20.0, false);
      DeadReckoning in_outage = reckoning;
      Water there = water;
      follow(in_outage, there, 30.0, true);
      const Drift drift = in_outage.drift();
      const double x = drift.position_m[0] - (there.position[0] - water.position[0]);
      const double y = drift.position_m[1] - (there.position[1] - water.position[1]);
      // The filter's frame begins where the simulated one does.
      const auto& p = drift.covariance_m2;
      const double square =
          (p[3] * x * x - 2.0 * p[1] * x * y + p[0] * y * y) / (p[0] * p[3] - p[1] * p[2]);
      inside += square < 4.605 ? 1 : 0;
    }
    EXPECT_GT(reckoning.noise_factor(), 1.5);
  }
  EXPECT_GT(inside, 0.80 * all);
  EXPECT_LT(inside, 0.99 * all);
}

TEST(DeadReckoning, BlendsBackWithoutAJumpAndShrugsOffAWildPing) {
  Water water({0.0, 0.0}, 0.01, 3);
  DeadReckoning reckoning(linear_vehicle());
  follow(reckoning, water, 60.0, false);
  follow(reckoning, water, 40.0, true);
  EXPECT_NEAR(reckoning.silent_s(), 40.0, 1e-9);
  const double spread = reckoning.deviation(0);
  EXPECT_GT(spread, 0.005);
  const double before = reckoning.velocity(0);
  water.advance();
  reckoning.update(water.sample(false), water.time_s());
  EXPECT_EQ(reckoning.silent_s(), 0.0);
  EXPECT_LT(std::abs(reckoning.velocity(0) - before), 4.0 * spread);
  EXPECT_LT(reckoning.deviation(0), 0.1 * spread);
  EXPECT_EQ(reckoning.drift().position_m[0], 0.0);

  const double calm = reckoning.velocity(0);
  water.advance();
  std::array<double, 6> wild = water.sample(false);
  wild[0] = 40.0;
  reckoning.update(wild, water.time_s());
  EXPECT_NEAR(reckoning.velocity(0), calm, 0.05);
}

TEST(DeadReckoning, GoesOnWithoutAYawRateAndTakesInAHeading) {
  Water water({0.0, 0.0}, 0.0, 4);
  DeadReckoning reckoning(linear_vehicle());
  follow(reckoning, water, 60.0, false);
  for (int k = 0; k < 40; ++k) {
    water.advance();
    std::array<double, 6> x = water.sample(true);
    x[2] = kNaN;
    reckoning.update(x, water.time_s());
  }
  EXPECT_NEAR(reckoning.velocity(2), water.velocity[2], 0.01);
  EXPECT_NEAR(reckoning.silent_s(), 10.0, 1e-9);
  reckoning.measured_heading(water.heading + 2.0 * std::acos(-1.0), 1e-4);  // once more round
  EXPECT_NEAR(reckoning.heading(), water.heading, 1e-3);
  EXPECT_THROW(reckoning.measured_heading(0.0, 0.0), InputError);
}

TEST(DeadReckoning, TheFirstHeadingIsTakenAsItIsAndTurnsTheCurrentWithIt) {
  Water water({0.15, -0.1}, 0.0, 1);
  DeadReckoning reckoning(linear_vehicle(0.002));
  DeadReckoning before_start = reckoning;
  before_start.measured_heading(1.5, 0.02);
  follow(reckoning, water, 600.0, false);
  const double change = 1.2 - reckoning.heading();
  const std::array<double, 2> c = reckoning.current();
  reckoning.measured_heading(1.2, 0.02);
  EXPECT_NEAR(std::remainder(reckoning.heading() - 1.2, 2.0 * std::acos(-1.0)), 0.0, 1e-9);
  EXPECT_NEAR(reckoning.current()[0], std::cos(change) * c[0] - std::sin(change) * c[1], 1e-9);
  EXPECT_NEAR(reckoning.current()[1], std::sin(change) * c[0] + std::cos(change) * c[1], 1e-9);
  reckoning.measured_heading(1.3, 0.02);  // from now on as any measurement
  EXPECT_GT(std::remainder(reckoning.heading(), 2.0 * std::acos(-1.0)), 1.21);
  EXPECT_LT(std::remainder(reckoning.heading(), 2.0 * std::acos(-1.0)), 1.29);

  Water again({0.0, 0.0}, 0.0, 1);
  follow(before_start, again, kStepS, false);
  EXPECT_TRUE(before_start.started());
  EXPECT_EQ(before_start.heading(), 1.5);
}

TEST(DeadReckoning, BeginsWithSamplesWhoseCovarianceTellsOfTheirOwnVelocitiesAlone) {
  DeadReckoning reckoning(linear_vehicle());
  const std::array log{1e-4, 0.0, kNaN, 0.0, 1e-4, kNaN, kNaN, kNaN, kNaN};
  const std::array gyro{kNaN, kNaN, kNaN, kNaN, kNaN, kNaN, kNaN, kNaN, 4e-4};
  reckoning.update(std::array{0.1, 0.0, kNaN, 0.0, 0.0, 0.0}, 0.0, log);
  reckoning.update(std::array{kNaN, kNaN, 0.1, 0.0, 0.0, 0.0}, 0.1, gyro);
  ASSERT_TRUE(reckoning.started());
  EXPECT_NEAR(reckoning.deviation(2), 0.02, 1e-9);
  EXPECT_NEAR(reckoning.deviation(0), 0.001, 1e-9);  // the noise that the model knows
  reckoning.update(std::array{0.1, 0.0, kNaN, 0.0, 0.0, 0.0}, 0.2, log);
  EXPECT_NEAR(reckoning.velocity(0), 0.1, 0.01);
}

TEST(DeadReckoning, WhatWasMovedFromCanBeAssignedTo) {
  Water water({0.0, 0.0}, 0.01, 9);
  DeadReckoning reckoning(linear_vehicle());
  follow(reckoning, water, 10.0, false);
  const DeadReckoning moved = std::move(reckoning);
  reckoning = moved;  // NOLINT(bugprone-use-after-move)
  EXPECT_EQ(reckoning.velocity(0), moved.velocity(0));
}

// Outside the plane, a gyro of its own.
DeadReckoningSettings with_gyro() {
  return {.planar = false, .rates = {2}};
}

// A sample of the gyro and one of the log.
void follow_apart(DeadReckoning& reckoning, Water& water, double seconds) {
  for (int k = 0; k < static_cast<int>(seconds / kStepS); ++k) {
    water.advance();
    const std::array<double, 6> x = water.sample(false);
    std::array<double, 6> log = x;
    std::array<double, 6> gyro = x;
    log[2] = gyro[0] = gyro[1] = kNaN;
    reckoning.update(gyro, water.time_s() - 0.1);
    reckoning.update(log, water.time_s());
  }
}

TEST(DeadReckoning, AGyroBetweenTwoPingsDoesNotHideThatTheVehicleIsElsewhere) {
  Water water({0.0, 0.0}, 0.001, 7);
  DeadReckoningSettings settings = with_gyro();
  settings.practice_s = 0.0;
  DeadReckoning reckoning(linear_vehicle(0.001), settings);
  follow_apart(reckoning, water, 60.0);
  water.velocity[0] -= 0.5;
  follow_apart(reckoning, water, 4.0 * kStepS);
  EXPECT_NEAR(reckoning.velocity(0), water.velocity[0], 0.03);
}

// The yaw rate of which the model explains half is measured in an outage of the log, too.
TEST(DeadReckoning, PractisesOutagesOfTheLogAloneOutsideThePlane) {
  Water water({0.0, 0.0}, 0.005, 12);
  OpenLoop loop = linear_vehicle(0.005);
  loop.error[2] = 0.002;
  loop.accelerations = [](std::span<const double> x, std::span<double> a) {
    for (std::size_t i = 0; i < 3; ++i) {
      a[i] = -kDrag * x[i] + (i == 2 ? 0.5 : 1.0) * x[3 + i];
    }
  };
  DeadReckoning reckoning(loop, with_gyro());
  follow_apart(reckoning, water, 1500.0);
  EXPECT_NE(reckoning.noise_factor(), 1.0);
  EXPECT_LT(reckoning.noise_factor(), 5.0);
}

// As fast as never in learning: practice knows what the filter has seen since.
TEST(DeadReckoning, PractisesAtSpeedsThatOnlyTheFilterHasSeen) {
  Water water({0.0, 0.0}, 0.005, 13);
  OpenLoop loop = linear_vehicle(0.005);
  loop.seen[0] = {0.0, 0.05};
  DeadReckoning reckoning(loop, {.current_m_s = 0.0});
  follow(reckoning, water, 1500.0, false);
  EXPECT_GT(reckoning.velocity(0), 0.1);
  EXPECT_LT(reckoning.noise_factor(), 5.0);
}

TEST(DeadReckoning, BeginsWithAWholeSampleAndKeepsACommandThatIsMissing) {
  DeadReckoning reckoning(linear_vehicle());
  reckoning.update(std::array{0.1, kNaN, 0.0, 0.0, 0.0, 0.0}, 0.0);
  EXPECT_FALSE(reckoning.started());
  reckoning.update(std::array{0.1, 0.0, 0.0, 0.02, 0.0, 0.0}, 1.0);
  EXPECT_TRUE(reckoning.started());
  reckoning.update(std::array{kNaN, kNaN, kNaN, kNaN, 0.0, 0.0}, 2.0);
  EXPECT_NEAR(reckoning.velocity(0), 0.1, 1e-6);                     // thrust and drag are level
  reckoning.update(std::array{0.1, 0.0, 0.0, 0.02, 0.0, 0.0}, 1.5);  // a clock that went back
  EXPECT_TRUE(std::isfinite(reckoning.velocity(0)));
}

TEST(DeadReckoning, OfVelocitiesThatArentPlanarTellsThemAlone) {
  OpenLoop loop = linear_vehicle();
  loop.states = {0};
  loop.error.resize(1);
  loop.error_time_s.resize(1);
  loop.noise.resize(1);
  loop.accelerations = [](std::span<const double> x, std::span<double> a) {
    a[0] = -kDrag * x[0] + x[3];
  };
  EXPECT_EQ(message_of<InputError>([&] { const DeadReckoning refused(loop); }),
            "planar: needs surge, sway and yaw rate as the first three velocities");
  DeadReckoning reckoning(loop, {.planar = false});
  reckoning.update(std::array{0.5, 0.0, 0.0, 0.0, 0.0, 0.0}, 0.0);
  reckoning.update(std::array{kNaN, 0.0, 0.0, 0.0, 0.0, 0.0}, 5.0);
  EXPECT_NEAR(reckoning.velocity(0), 0.5 * std::exp(-1.0), 1e-3);
  EXPECT_EQ(reckoning.drift().position_m[0], 0.0);
}

TEST(DeadReckoning, RefusesWhatDoesntFit) {
  DeadReckoning reckoning(linear_vehicle());
  EXPECT_THROW(reckoning.update(std::array{0.0}, 0.0), InputError);
  EXPECT_THROW(reckoning.update(std::array{0.0, 0.0, 0.0, 0.0, 0.0, 0.0}, kNaN), InputError);
  EXPECT_THROW(reckoning.update(std::array{0.0, 0.0, 0.0, 0.0, 0.0, 0.0}, 0.0, std::array{1.0}),
               InputError);
  EXPECT_FALSE(reckoning.started());
  EXPECT_THROW(DeadReckoning(linear_vehicle(), {.step_s = 0.0}), InputError);
  EXPECT_THROW(DeadReckoning(linear_vehicle(), {.current_m_s = -1.0}), InputError);
}

TEST(DeadReckoning, AllocatesNothingAfterItsConstruction) {
  KELPIE_NEEDS_ALLOCATION_COUNT();
  Water water({0.1, 0.0}, 0.01, 5);
  DeadReckoning reckoning(linear_vehicle());
  water.advance();
  const std::array<double, 6> first = water.sample(false);
  const std::size_t before = testing::allocations;
  reckoning.update(first, water.time_s());
  for (int k = 0; k < 400; ++k) {
    water.advance();
    reckoning.update(water.sample(k > 200 && k < 300), water.time_s());
  }
  reckoning.measured_heading(0.0, 0.1);
  EXPECT_EQ(testing::allocations, before);
}

// What the velocity log gives in place of a measurement, for so many seconds.
enum class Broken { zeros, frozen };

// Runs through a fault of the velocity log; the time until the fault has a name, and what is said.
struct Named {
  double after_s = kNaN;
  VelocityFault fault = VelocityFault::none;
};

Named run_broken(DeadReckoning& reckoning, Water& water, double seconds, Broken how) {
  Named named;
  std::array<double, 6> last = water.sample(false);
  for (int k = 0; k < static_cast<int>(seconds / kStepS); ++k) {
    water.advance();
    std::array<double, 6> x = water.sample(false);
    for (std::size_t i = 0; i < 2; ++i) {
      x[i] = how == Broken::zeros ? 0.0 : last[i];
    }
    reckoning.update(x, water.time_s());
    const VelocityFault fault = reckoning.fault(0);
    if (std::isnan(named.after_s) &&
        (fault == VelocityFault::zero || fault == VelocityFault::frozen)) {
      named = {.after_s = (k + 1) * kStepS, .fault = fault};
    }
  }
  return named;
}

TEST(DeadReckoning, RecognisesExactZerosAndAFrozenLogWithinASecondAndReturnsWithoutAJump) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    for (const Broken how : {Broken::zeros, Broken::frozen}) {
      Water water({0.0, 0.0}, 0.01, seed);
      DeadReckoning reckoning(linear_vehicle());
      follow(reckoning, water, 300.0, false);
      const Named named = run_broken(reckoning, water, 60.0, how);
      EXPECT_LE(named.after_s, 1.0);
      EXPECT_EQ(named.fault, how == Broken::zeros ? VelocityFault::zero : VelocityFault::frozen);
      EXPECT_EQ(reckoning.fault(2), VelocityFault::none);  // of the gyro
      EXPECT_GE(reckoning.silent_s(), 59.0);
      EXPECT_NEAR(reckoning.velocity(0), water.velocity[0], 0.1);
      for (int k = 0; k < 20; ++k) {
        follow(reckoning, water, kStepS, false);
        EXPECT_LE(reckoning.step(), 3.0 + 1e-9);
      }
      EXPECT_NEAR(reckoning.velocity(0), water.velocity[0], 0.01);
    }
  }
}

// Off, with a covariance far too small: the estimate never jumps beyond what was said before.
// Surge, heave and a gyro's yaw rate, told by their names alone.
TEST(DeadReckoning, AngularVelocitiesByNameAreOfAGyro) {
  for (const Broken how : {Broken::zeros, Broken::frozen}) {
    Water water({0.0, 0.0}, 0.01, 14);
    OpenLoop loop = linear_vehicle();
    loop.axes = {0, 2, 5};
    DeadReckoning reckoning(loop, {.planar = false});
    follow(reckoning, water, 300.0, false);
    const Named named = run_broken(reckoning, water, 60.0, how);
    EXPECT_LE(named.after_s, 1.0);
    EXPECT_EQ(named.fault, how == Broken::zeros ? VelocityFault::zero : VelocityFault::frozen);
    EXPECT_EQ(reckoning.fault(2), VelocityFault::none);
    EXPECT_GE(reckoning.silent_s(), 59.0);
    EXPECT_NEAR(reckoning.velocity(0), water.velocity[0], 0.1);
  }
  OpenLoop turning = linear_vehicle();  // a log of angular velocities alone
  turning.axes = {3, 4, 5};
  Water water({0.0, 0.0}, 0.0, 15);
  DeadReckoning reckoning(turning, {.planar = false});
  follow(reckoning, water, 10.0, false);
  EXPECT_EQ(reckoning.silent_s(), 0.0);
}

TEST(DeadReckoning, IsPlanarUnlessANameSaysOtherwise) {
  const auto refusal = [](std::vector<std::optional<std::size_t>> axes) {
    OpenLoop loop = linear_vehicle();
    loop.axes = std::move(axes);
    return message_of<InputError>([&] { const DeadReckoning reckoning(loop); });
  };
  EXPECT_EQ(refusal({0, 1, 2}),  // heave is no yaw rate
            "planar: needs surge, sway and yaw rate as the first three velocities");
  EXPECT_TRUE(refusal({5, 1, std::nullopt}).starts_with("planar: "));
  OpenLoop loop = linear_vehicle();
  for (const auto& axes :
       {std::vector<std::optional<std::size_t>>{0, 1, 5}, {0, 1, std::nullopt}}) {
    loop.axes = axes;
    EXPECT_NO_THROW(DeadReckoning{loop});
  }
}

TEST(DeadReckoning, NeverStepsBeyondThreeDeviationsHoweverWrong) {
  Water water({0.0, 0.0}, 0.001, 11);
  DeadReckoning reckoning(linear_vehicle(0.0005), {.practice_s = 0.0});
  follow(reckoning, water, 120.0, false);
  follow(reckoning, water, 30.0, true);
  water.velocity[0] += 0.4;  // a collision
  for (int k = 0; k < 12; ++k) {
    follow(reckoning, water, kStepS, false);
    EXPECT_LE(reckoning.step(), 3.0 + 1e-9);
  }
  EXPECT_NEAR(reckoning.velocity(0), water.velocity[0], 0.02);
}

// A model that tells of errors far too large: practice narrows what is said of the velocities.
TEST(DeadReckoning, StepsBackByWhatWasSaidAfterAnOutage) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Water water({0.0, 0.0}, 0.0, seed);
    DeadReckoning reckoning(linear_vehicle(0.02));
    follow(reckoning, water, 900.0, false);
    follow(reckoning, water, 20.0, true);
    water.velocity[0] += 0.6;  // a collision
    for (int k = 0; k < 8; ++k) {
      follow(reckoning, water, kStepS, false);
      EXPECT_LE(reckoning.step(), 3.0 + 1e-9);
    }
  }
}

// A simulator's vehicle at rest, to the last bit: not measured for three seconds, then measured.
void expect_rest(DeadReckoning reckoning) {
  double t = 0.0;
  const auto rest = [&](double seconds) {
    double silent_s = 0.0;
    for (int k = 0; k < static_cast<int>(seconds / kStepS); ++k, t += kStepS) {
      reckoning.update(std::array{0.0, 0.0, 0.0, 0.0, 0.0, 0.0}, t);
      silent_s = std::max(silent_s, reckoning.silent_s());
      EXPECT_NE(reckoning.fault(0), VelocityFault::zero);
      EXPECT_NE(reckoning.fault(0), VelocityFault::frozen);
    }
    return silent_s;
  };
  EXPECT_LE(rest(60.0), 3.0);
  EXPECT_EQ(reckoning.silent_s(), 0.0);
  EXPECT_LT(reckoning.deviation(0), 0.01);
  // The thrusters push and the log goes on with zeros: a fault at once.
  for (int k = 0; k < 2; ++k, t += kStepS) {
    reckoning.update(std::array{0.0, 0.0, 0.0, 0.1, 0.0, 0.0}, t);
  }
  EXPECT_EQ(reckoning.fault(0), VelocityFault::zero);
}

TEST(DeadReckoning, AVehicleAtRestIsNotFrozenForLongerThanStated) {
  for (const CommandPath between : {CommandPath::linear, CommandPath::held}) {
    expect_rest(DeadReckoning(linear_vehicle(), {.between = between}));
  }
}

// A simulator's vehicle at rest, of which practice is never wrong.
TEST(DeadReckoning, PracticeWithoutAnErrorLeavesDeviations) {
  DeadReckoning reckoning(linear_vehicle(), {.checks = false});
  for (int k = 0; k < 4000; ++k) {
    const double measured = k < 3600 || k > 3680 ? 0.0 : kNaN;
    reckoning.update(std::array{measured, measured, 0.0, 0.0, 0.0, 0.0}, kStepS * k);
  }
  reckoning.update(std::array{kNaN, kNaN, 0.0, 0.0, 0.0, 0.0}, 1020.0);
  EXPECT_GT(reckoning.deviation(0), 0.0);
  reckoning.update(std::array{0.1, 0.0, 0.0, 0.0, 0.0, 0.0}, 1020.25);
  EXPECT_GT(reckoning.velocity(0), 0.0);
  EXPECT_LE(reckoning.step(), 3.0 + 1e-9);
}

// A velocity log at 1 Hz, whose driver repeats the value at 4 Hz, and a gyro in samples of its own.
TEST(DeadReckoning, HeldValuesAreNoNewMeasurementAndNoFault) {
  Water water({0.0, 0.0}, 0.01, 8);
  DeadReckoning reckoning(linear_vehicle());
  std::array<double, 6> held{};
  int frozen = 0;
  for (int k = 0; k < 1200; ++k) {
    water.advance();
    const std::array<double, 6> x = water.sample(false);
    held = k % 4 == 0 ? x : held;
    std::array<double, 6> log = x;
    std::array<double, 6> gyro = x;
    log[0] = held[0];
    log[1] = held[1];
    log[2] = gyro[0] = gyro[1] = kNaN;
    reckoning.update(gyro, water.time_s() - 0.01);
    reckoning.update(log, water.time_s());
    frozen += k > 200 && reckoning.fault(0) == VelocityFault::frozen ? 1 : 0;
    if (k > 400) {
      EXPECT_NEAR(reckoning.velocity(0), water.velocity[0], 0.06);
    }
  }
  EXPECT_TRUE(reckoning.started());
  EXPECT_EQ(frozen, 0);
  EXPECT_NE(reckoning.noise_factor(), 1.0);  // practice goes on between held values
}

TEST(DeadReckoning, GoesOnWithALaterModel) {
  Water water({0.0, 0.0}, 0.01, 9);
  DeadReckoning reckoning(linear_vehicle());
  follow(reckoning, water, 60.0, false);
  const double before = reckoning.velocity(0);
  reckoning.use(linear_vehicle(0.02));
  EXPECT_EQ(reckoning.velocity(0), before);
  follow(reckoning, water, 60.0, false);
  EXPECT_NEAR(reckoning.velocity(0), water.velocity[0], 0.01);
  OpenLoop other = linear_vehicle();
  other.states = {1, 0, 2};
  EXPECT_EQ(message_of<InputError>([&] { reckoning.use(other); }),
            "states: have to be those of the first model");
}

// Pulses in place of efforts, as before an alignment is found.
constexpr double kRest = 1500.0;

OpenLoop vehicle_of_pulses() {
  OpenLoop loop = linear_vehicle();
  loop.accelerations = [](std::span<const double> x, std::span<double> a) {
    for (std::size_t i = 0; i < 3; ++i) {
      a[i] = -kDrag * x[i] + x[3 + i] - kRest;
    }
  };
  for (std::size_t i = 3; i < 6; ++i) {
    loop.seen[i] = {loop.seen[i].low + kRest, loop.seen[i].high + kRest};
  }
  return loop;
}

// Later models have taken the current for a push and less drag, as learned over ground.
TEST(DeadReckoning, ACurrentThatBeginsIsNotCountedTwice) {
  Water water({0.0, 0.0}, 0.002, 8);
  DeadReckoning reckoning(linear_vehicle());
  DeadReckoning spoiled(linear_vehicle(0.01, 0.12, 0.02));
  follow(reckoning, water, 120.0, false);
  water.set_current({0.15, -0.1});
  for (int k = 0; k < 60; ++k) {
    for (int step = 0; step < 40; ++step) {
      water.advance();
      const std::array<double, 6> x = water.sample(false);
      reckoning.update(x, water.time_s());
      spoiled.update(x, water.time_s());
    }
    reckoning.use(linear_vehicle(0.01, 0.12, 0.02));
  }
  EXPECT_NEAR(reckoning.current()[0], 0.15, 0.05);
  EXPECT_NEAR(reckoning.current()[1], -0.1, 0.05);
  const double off = off_after(reckoning, water, 60.0);
  EXPECT_LT(off, 1.0);
  EXPECT_LT(off, 0.5 * off_after(spoiled, water, 60.0));
}

// The other way round: the vehicle has changed, and the later models know.
TEST(DeadReckoning, AVehicleThatChangesIsFollowedByTheLaterModels) {
  Water water({0.0, 0.0}, 0.002, 9);
  DeadReckoning reckoning(linear_vehicle());
  follow(reckoning, water, 300.0, false);
  water.drag = 0.4;
  for (int k = 0; k < 30; ++k) {
    follow(reckoning, water, 10.0, false);
    reckoning.use(linear_vehicle(0.01, 0.4));
  }
  EXPECT_LT(off_after(reckoning, water, 60.0), 0.3);
}

TEST(DeadReckoning, CommandsInOtherUnitsMakeNoStep) {
  Water water({0.0, 0.0}, 0.01, 9);
  DeadReckoning reckoning(vehicle_of_pulses());
  for (int k = 0; k < 240; ++k) {
    water.advance();
    std::array<double, 6> x = water.sample(false);
    std::for_each(x.begin() + 3, x.end(), [](double& command) { command += kRest; });
    reckoning.update(x, water.time_s());
  }
  reckoning.use(linear_vehicle());
  water.advance();
  const std::array<double, 6> x = water.sample(true);
  reckoning.restate(x, CommandPath::linear);
  reckoning.update(x, water.time_s());
  EXPECT_NEAR(reckoning.velocity(0), water.velocity[0], 0.01);
  follow(reckoning, water, 10.0, true);
  EXPECT_NEAR(reckoning.velocity(0), water.velocity[0], 0.05);
}

TEST(DeadReckoning, FaultsHaveNames) {
  EXPECT_EQ(fault_name(VelocityFault::none), "none");
  EXPECT_EQ(fault_name(VelocityFault::implausible), "implausible");
}

}  // namespace
}  // namespace kelpie::dead_reckoning_test
