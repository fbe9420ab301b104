// SPDX-License-Identifier: Apache-2.0
#include "model/change_monitor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include "allocation_count.hpp"
#include "model/planar_drive.hpp"
#include "saved_state.hpp"

namespace kelpie::change_monitor_test {
namespace {

using Event = ChangeMonitor::Event;
using testing::PlanarDrive;
using testing::saved;

constexpr std::array<std::size_t, 2> kStates{0, 1};
constexpr std::array<std::size_t, 2> kCommands{2, 3};

TermSet terms() {
  return TermSet::from("auto", PlanarDrive{}.inputs, 2);
}

ChangeMonitor make_monitor() {
  return {terms(), kStates, kCommands};
}

// Noise with a correlation time of two seconds, and one outlier in two hundred rows.
void add_noise(PlanarDrive& drive, double step_s, std::uint64_t seed) {
  RandomStream random(seed, "noise");
  const double keep = std::exp(-step_s / 2.0);
  std::array<double, 2> coloured{};
  for (std::array<double, 2>& y : drive.y) {
    for (std::size_t axis = 0; axis < y.size(); ++axis) {
      coloured[axis] = keep * coloured[axis] + std::sqrt(1.0 - keep * keep) * random.normal();
      y[axis] += 0.02 * (coloured[axis] + random.normal());
      y[axis] += random.uniform() < 0.005 ? 0.5 : 0.0;
    }
  }
}

PlanarDrive damaged(double step_s, double before_s, double after_s, double strength,
                    double other = 1.0) {
  PlanarDrive drive;
  drive.drive(1, static_cast<std::size_t>(before_s / step_s), step_s);
  drive.drive(2, static_cast<std::size_t>(after_s / step_s), step_s, strength, other);
  add_noise(drive, step_s, 3);
  return drive;
}

struct Story {
  std::vector<double> changed, withdrawn, since;  // [s]
  std::array<std::vector<double>, 2> moved;       // sum of the steps of each axis
  std::array<double, 2> factor{1.0, 1.0};         // product of the gains of each command
};

Story watch(ChangeMonitor& monitor, const PlanarDrive& drive) {
  Story story;
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    const Event event = monitor.update(drive.x[i], drive.y[i], drive.t[i]);
    if (event == Event::none) {
      continue;
    }
    if (event == Event::changed) {
      story.changed.push_back(drive.t[i]);
      story.since.push_back(monitor.since());
    }
    if (event == Event::withdrawn) {
      story.withdrawn.push_back(drive.t[i]);
    }
    for (std::size_t c = 0; monitor.by_gain() && c < 2; ++c) {
      EXPECT_EQ(monitor.gains()[c].input, kCommands[c]);
      story.factor[c] *= monitor.gains()[c].factor;
    }
    for (std::size_t axis = 0; !monitor.by_gain() && axis < 2; ++axis) {
      const std::span<const double> step = monitor.step(axis);
      story.moved[axis].resize(step.size());
      std::ranges::transform(step, story.moved[axis], story.moved[axis].begin(), std::plus<>{});
    }
  }
  return story;
}

TEST(ChangeMonitor, BelievesInAHalvedThrusterAtAnyRate) {
  for (const double step_s : {0.05, 0.2, 0.5}) {
    const PlanarDrive drive = damaged(step_s, 1200.0, 100.0, 0.5);
    ChangeMonitor monitor = make_monitor();
    const Story story = watch(monitor, drive);
    ASSERT_EQ(story.changed.size(), 1U) << step_s;
    EXPECT_GT(story.changed[0], 1200.0) << step_s;
    EXPECT_LT(story.changed[0], 1230.0) << step_s;
    EXPECT_NEAR(story.since[0], 1200.0, 15.0) << step_s;
    EXPECT_TRUE(story.withdrawn.empty()) << step_s;
  }
}

// Stamps since 1970 are rounded to 0.2 µs.
TEST(ChangeMonitor, RowsCountHoweverTheirStampsAreRounded) {
  PlanarDrive drive;
  drive.drive(1, 100, 0.24);
  for (const double zero : {0.0, 1.7e9}) {
    ChangeMonitor monitor = make_monitor();
    for (std::size_t i = 0; i < drive.x.size(); ++i) {
      const std::string before = saved(monitor);
      monitor.update(drive.x[i], drive.y[i], zero + 0.24 * static_cast<double>(i));
      EXPECT_NE(saved(monitor), before) << zero << " " << i;
    }
  }
}

// Half of the thrust n1|n1| is the thrust of n1 √½.
TEST(ChangeMonitor, TellsTheFactorOfACommandThatHasLostHalfOfItsEffect) {
  ChangeMonitor monitor = make_monitor();
  const Story story = watch(monitor, damaged(0.2, 1200.0, 100.0, 0.5));
  EXPECT_TRUE(monitor.by_gain());
  EXPECT_NEAR(story.factor[0], std::sqrt(0.5), 0.02);
  EXPECT_DOUBLE_EQ(story.factor[1], 1.0);
}

// Two thrusters at once: half takes away 0.005 n1|n1| in surge and 0.01 n1|n1| in yaw, 1.6 times
// adds 0.006 n2|n2| and takes away 0.012 n2|n2|.
TEST(ChangeMonitor, TellsByHowMuchTheCoefficientsHaveChanged) {
  ChangeMonitor monitor = make_monitor();
  const Story story = watch(monitor, damaged(0.2, 1200.0, 100.0, 0.5, 1.6));
  ASSERT_EQ(story.changed.size(), 1U);
  EXPECT_FALSE(monitor.by_gain());
  const TermSet set = terms();
  ASSERT_EQ(story.moved[0].size(), set.size() + 1);
  std::vector<double> phi(set.size());
  for (const std::array n : {std::array{-6.0, 0.0}, std::array{6.0, 0.0}, std::array{0.0, 6.0}}) {
    set.evaluate(std::array{0.0, 0.0, n[0], n[1]}, phi);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const double more =
          std::inner_product(phi.begin(), phi.end(), story.moved[axis].begin(), 0.0);
      const double truth = (axis == 0 ? -0.005 : -0.01) * n[0] * std::abs(n[0]) +
                           (axis == 0 ? 0.006 : -0.012) * n[1] * std::abs(n[1]);
      EXPECT_NEAR(more, truth, 0.1 * std::abs(truth)) << n[0] << " " << n[1] << " " << axis;
    }
  }
}

TEST(ChangeMonitor, RaisesNoAlarmInHoursOfColouredNoiseWithOutliers) {
  PlanarDrive drive;
  for (std::uint64_t part = 0; part < 12; ++part) {
    drive.drive(10 + part, 4500, 0.2);  // other commands every 15 minutes
  }
  add_noise(drive, 0.2, 4);
  ChangeMonitor monitor = make_monitor();
  EXPECT_TRUE(watch(monitor, drive).changed.empty());
}

// The vehicle holds its speed where the model is a little wrong: a disturbance would do the same.
TEST(ChangeMonitor, AConstantErrorAtOneSpeedIsNoChange) {
  PlanarDrive drive;
  drive.drive(1, 6000, 0.2);
  add_noise(drive, 0.2, 3);
  RandomStream random(5, "held");
  const std::array<double, 4> held = drive.x.back();
  const std::array<double, 2> y = PlanarDrive::accelerations(held);
  for (int i = 0; i < 500; ++i) {
    drive.x.push_back(held);
    drive.y.push_back({y[0] + 0.1 + 0.03 * random.normal(), y[1] - 0.1 + 0.03 * random.normal()});
    drive.t.push_back(drive.t.back() + 0.2);
  }
  ChangeMonitor monitor = make_monitor();
  EXPECT_TRUE(watch(monitor, drive).changed.empty());
}

// Six minutes are too short for the monitor to know the vehicle; a diagnosis names the cause ten
// seconds after the change.
class NamedCause : public ::testing::Test {
 protected:
  static constexpr double kStep = 0.2;
  static constexpr std::size_t kBefore = 1800;
  static constexpr std::size_t kNamed = kBefore + 50;

  Story watch_with(const Cause& cause, double strength) {
    const PlanarDrive drive = damaged(kStep, 360.0, 100.0, strength);
    const double since_s = drive.t[kBefore - 1];
    PlanarDrive part = drive;
    part.x.resize(kNamed);
    part.y.resize(kNamed);
    part.t.resize(kNamed);
    EXPECT_TRUE(watch(monitor_, part).changed.empty());
    at_once_ = monitor_.believe_cause(cause, since_s);
    first_ = at_once_ == Event::changed && monitor_.by_gain() ? monitor_.gains()[0].factor : 1.0;
    again_ = monitor_.believe_cause(cause, since_s);
    part.x.assign(drive.x.begin() + kNamed, drive.x.end());
    part.y.assign(drive.y.begin() + kNamed, drive.y.end());
    part.t.assign(drive.t.begin() + kNamed, drive.t.end());
    return watch(monitor_, part);
  }

  ChangeMonitor monitor_ = make_monitor();
  Event at_once_ = Event::none;
  Event again_ = Event::none;
  double first_ = 1.0;
};

TEST_F(NamedCause, IsFollowedAtOnceAndRefined) {
  const Story story = watch_with({.kind = CauseKind::thruster, .place = 2, .size = 0.55}, 0.5);
  EXPECT_EQ(at_once_, Event::changed);
  EXPECT_EQ(again_, Event::none) << "followed already";
  EXPECT_TRUE(story.withdrawn.empty());
  EXPECT_NEAR(first_, std::sqrt(0.55), 0.1);
  EXPECT_NEAR(first_ * story.factor[0], std::sqrt(0.5), 0.05);
}

TEST_F(NamedCause, IsTakenBackWhereRowsContradict) {
  const Story story = watch_with({.kind = CauseKind::thruster, .place = 2, .size = 0.1}, 1.0);
  EXPECT_EQ(at_once_, Event::changed);
  if (story.withdrawn.empty()) {  // or refined away
    EXPECT_NEAR(first_ * story.factor[0], 1.0, 0.05);
  } else {
    EXPECT_NEAR(first_ * story.factor[0], 1.0, 1e-9);
  }
}

TEST_F(NamedCause, IsTakenBackWithTheFinding) {
  const Cause half{CauseKind::thruster, kCommands[0], 0.5, 0.45, 0.55};
  const PlanarDrive drive = damaged(kStep, 360.0, 4.0, 0.5);
  watch(monitor_, drive);
  EXPECT_EQ(monitor_.disbelieve_cause(), Event::none);
  ASSERT_EQ(monitor_.believe_cause(half, 360.0), Event::changed);
  EXPECT_EQ(monitor_.named_command(), kCommands[0]);
  const double factor = monitor_.gains()[0].factor;
  EXPECT_EQ(monitor_.disbelieve_cause(), Event::withdrawn);
  EXPECT_DOUBLE_EQ(monitor_.gains()[0].factor * factor, 1.0);
  EXPECT_FALSE(monitor_.named_command());
}

TEST_F(NamedCause, OfAnotherKindChangesNothing) {
  for (const Cause& cause : {Cause{.kind = CauseKind::thruster, .place = 0, .size = 0.5},
                             Cause{.kind = CauseKind::drag, .place = 1, .size = 1.5},
                             Cause{.kind = CauseKind::force, .place = 0, .size = 0.5},
                             Cause{.kind = CauseKind::sensor_scale, .place = 0, .size = 0.5}}) {
    EXPECT_EQ(monitor_.believe_cause(cause, 1.0), Event::none);
    watch_with(cause, 1.0);
    EXPECT_EQ(at_once_, Event::none);
    monitor_ = make_monitor();
  }
}

TEST(ChangeMonitor, WithdrawsAChangeThatPasses) {
  constexpr double kStep = 0.2;
  PlanarDrive drive;
  drive.drive(1, 6000, kStep);
  drive.drive(2, 200, kStep, 0.5);
  drive.drive(3, 500, kStep);
  add_noise(drive, kStep, 3);
  ChangeMonitor monitor = make_monitor();
  const Story story = watch(monitor, drive);
  ASSERT_EQ(story.changed.size(), 1U);
  ASSERT_EQ(story.withdrawn.size(), 1U);
  EXPECT_GT(story.withdrawn[0], 1240.0);
  for (const double moved : story.moved[0]) {
    EXPECT_NEAR(moved, 0.0, 1e-9);  // all steps are taken back
  }
}

TEST(ChangeMonitor, ContinuesFromItsStateInTheMiddleOfAChange) {
  const PlanarDrive drive = damaged(0.2, 1200.0, 100.0, 0.5);
  std::size_t events = 0;
  testing::expect_same_life(
      make_monitor, drive.x.size(),
      [](std::size_t i) { return i % 613 == 0 || (i > 6000 && i % 37 == 0); },
      [&](ChangeMonitor& monitor, std::size_t i) {
        events += monitor.update(drive.x[i], drive.y[i], drive.t[i]) == Event::none ? 0 : 1;
      });
  EXPECT_GT(events, 40U);
}

TEST(ChangeMonitor, AllocatesNothing) {
  KELPIE_NEEDS_ALLOCATION_COUNT();
  const PlanarDrive drive = damaged(0.2, 1200.0, 200.0, 0.5);
  ChangeMonitor monitor = make_monitor();
  const std::size_t before = testing::allocations;
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    monitor.update(drive.x[i], drive.y[i], drive.t[i]);
  }
  EXPECT_EQ(testing::allocations, before);
}

}  // namespace
}  // namespace kelpie::change_monitor_test
