// SPDX-License-Identifier: Apache-2.0
#include "kelpie/vehicle/diagnosis.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "allocation_count.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "saved_state.hpp"
#include "vehicle/drive.hpp"

namespace kelpie::diagnosis_test {
namespace {

using testing::Drive;
using testing::drive_diagnosis;
using testing::load;
using testing::saved;

constexpr std::size_t kBefore = 2400;  // rows: ten minutes
constexpr std::size_t kMinute = 240;

const std::vector<std::string> kInputs{"u", "v", "r", "th1", "th2", "th3"};
const std::vector<std::string> kTargets{"udot", "vdot", "rdot"};

// What is said a minute after a change.
Diagnosis after(const Drive::Fault& fault, std::uint64_t seed, const Drive::Fault& before = {}) {
  Diagnosis diagnosis = drive_diagnosis();
  Drive drive(seed);
  drive.show(kBefore, before, diagnosis);
  drive.show(kMinute, fault, diagnosis);
  return diagnosis;
}

void expect_named(const Drive::Fault& fault, CauseKind kind, std::size_t place, double size) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Diagnosis diagnosis = after(fault, seed);
    ASSERT_EQ(diagnosis.findings().size(), 1U) << seed;
    const Finding& finding = diagnosis.findings().front();
    ASSERT_EQ(finding.state, FindingState::named) << finding_text(finding, {kInputs, kTargets});
    EXPECT_EQ(finding.count, 1U);
    const Cause& cause = finding.causes[0];
    EXPECT_EQ(cause.kind, kind) << cause_text(cause, {kInputs, kTargets});
    EXPECT_EQ(cause.place, place);
    EXPECT_NEAR(cause.size, size, 0.03 * std::max(std::abs(size), 0.1));
    EXPECT_NEAR(finding.since_s, 600.0, 8.0);
    EXPECT_LT(finding.told_s - 600.0, 30.0);
  }
}

TEST(Diagnosis, NamesAWeakThruster) {
  expect_named({.thrust = {1.0, 0.8, 1.0}}, CauseKind::thruster, 4, 0.8);
  expect_named({.thrust = {0.2, 1.0, 1.0}}, CauseKind::thruster, 3, 0.2);
}

TEST(Diagnosis, NamesASaggingBattery) {
  expect_named({.thrust = {0.8, 0.8, 0.8}}, CauseKind::all_thrusters, 0, 0.8);
  const Diagnosis diagnosis = after({.thrust = {0.7, 0.7, 0.7}}, 1);
  for (const Cause& thruster : diagnosis.present()) {
    EXPECT_NEAR(thruster.size, 0.7, 0.03) << thruster.place;
  }
}

// A ship with a rudder behind its screw.
class Ship {
 public:
  // Shows so many rows. The screw turns at `screw` and up to a third more.
  void show(std::size_t rows, double screw, double rudder_share) {
    for (std::size_t i = 0; i < rows; ++i) {
      t_ += 0.25;
      const double n = screw * (1.15 + 0.15 * std::sin(0.11 * t_) + 0.05 * std::sin(0.31 * t_));
      const double rudder = 0.3 * std::sin(0.17 * t_) + 0.2 * std::sin(0.41 * t_ + 1.0);
      auto& [u, v, r] = velocities_;
      const double lift = -rudder_share * rudder * (0.05 * n * n + u * std::abs(u));
      const std::array<double, 3> a{0.01 * n * n - 0.3 * u * std::abs(u),
                                    0.1 * lift - 0.5 * v - 0.2 * u * r,
                                    0.2 * lift - 0.4 * r - 0.5 * r * std::abs(r)};
      std::array<double, 5> x{u, v, r, n, rudder};
      std::array<double, 3> y = a;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        x[axis] += 2e-4 * random_.normal();
        y[axis] += 1e-3 * random_.normal();
        velocities_[axis] += 0.25 * a[axis];
      }
      diagnosis.update(x, y, t_);
    }
  }

  Diagnosis diagnosis{5, {0, 1, 2}, {0, 1, 5}};

 private:
  RandomStream random_{7, "ship"};
  std::array<double, 3> velocities_{};
  double t_ = 0.0;
};

// A rudder's force is not that of its angle: faster, the ship turns as the same ship does.
TEST(Diagnosis, KnowsThatARudderNeedsFlow) {
  Ship ship;
  ship.show(kBefore, 3.0, 1.0);
  ship.show(2 * kBefore, 6.0, 1.0);
  EXPECT_EQ(ship.diagnosis.found(), 0U);
  ship.show(kMinute, 4.5, 0.6);
  ASSERT_EQ(ship.diagnosis.findings().size(), 1U);
  const Cause& cause = ship.diagnosis.findings().front().causes[0];
  EXPECT_EQ(cause.kind, CauseKind::thruster);
  EXPECT_EQ(cause.place, 4U);
  EXPECT_NEAR(cause.size, 0.6, 0.02);
}

TEST(Diagnosis, NamesDragForceAndLoad) {
  expect_named({.drag = 1.4}, CauseKind::drag, 1, 1.4);
  expect_named({.force = -0.03}, CauseKind::force, 0, -0.03);
  expect_named({.inertia = 1.3}, CauseKind::load, 0, 1.3);
}

TEST(Diagnosis, NamesSensors) {
  expect_named({.scale = 1.3}, CauseKind::sensor_scale, 2, 1.3);
  expect_named({.bias = 0.05}, CauseKind::sensor_bias, 0, 0.05);
}

TEST(Diagnosis, NamesAFrozenSensorAndWhen) {
  const Diagnosis diagnosis = after({.frozen = true}, 1);
  ASSERT_EQ(diagnosis.findings().size(), 1U);
  const Finding& finding = diagnosis.findings().front();
  EXPECT_EQ(finding.causes[0].kind, CauseKind::frozen);
  EXPECT_EQ(finding.causes[0].place, 1U);
  EXPECT_NEAR(finding.since_s, 600.0, 0.5);
}

// What a sensor shows from a row on is its last value.
void freeze(const std::array<std::size_t, 2>& from, const std::array<std::size_t, 2>& which,
            Diagnosis& diagnosis) {
  Drive drive(1);
  std::size_t row = 0;
  Drive::Row last{};
  drive.show(kBefore + kMinute, {}, [&](Drive::Row x, Drive::Accelerations y, double t) {
    for (std::size_t i = 0; i < which.size(); ++i) {
      if (row >= kBefore + from[i]) {
        x[which[i]] = last[which[i]];
        y[which[i]] = 0.0;
      }
    }
    ++row;
    last = x;
    diagnosis.update(x, y, t);
  });
}

TEST(Diagnosis, NamesEverySensorThatFreezes) {
  Diagnosis later = drive_diagnosis();
  freeze({0, 80}, {1, 2}, later);
  ASSERT_EQ(later.findings().size(), 2U);
  EXPECT_EQ(later.findings()[0].causes[0].place, 1U);
  EXPECT_EQ(later.findings()[1].causes[0].place, 2U);
  EXPECT_NEAR(later.findings()[1].since_s, 620.0, 0.5);

  Diagnosis together = drive_diagnosis();
  freeze({0, 0}, {2, 0}, together);
  ASSERT_EQ(together.findings().size(), 1U);
  ASSERT_EQ(together.findings()[0].count, 2U);
  EXPECT_EQ(together.findings()[0].causes[0].place, 0U);
  EXPECT_EQ(together.findings()[0].causes[1].place, 2U);
  EXPECT_EQ(together.findings()[0].causes[1].kind, CauseKind::frozen);
}

// A load resists as an observer at rest sees it, in whatever order the velocities come.
TEST(Diagnosis, ALoadIsTheSameInEveryOrderOfTheVelocities) {
  const Diagnosis usual = after({.inertia = 1.3}, 2);
  Diagnosis turned(6, {1, 2, 0}, {0, 1, 5});
  Drive drive(2);
  const auto show = [&](const Drive::Row& x, const Drive::Accelerations& y, double t) {
    turned.update(std::array{x[2], x[0], x[1], x[3], x[4], x[5]}, y, t);
  };
  drive.show(kBefore, {}, show);
  drive.show(kMinute, {.inertia = 1.3}, show);
  ASSERT_EQ(turned.findings().size(), 1U);
  const Cause& cause = turned.findings()[0].causes[0];
  EXPECT_EQ(cause.kind, CauseKind::load);
  EXPECT_NEAR(cause.size, usual.findings()[0].causes[0].size, 1e-4);
  EXPECT_NEAR(turned.findings()[0].evidence, usual.findings()[0].evidence,
              1e-3 * usual.findings()[0].evidence);
}

// A roll rate without a target is measured and is no thruster.
TEST(Diagnosis, OtherInputsAreNoThrusters) {
  Diagnosis diagnosis(7, {0, 1, 2}, {0, 1, 5}, {}, std::array{std::size_t{6}});
  Drive drive(3);
  drive.show(kBefore, {}, [&](const Drive::Row& x, const Drive::Accelerations& y, double t) {
    diagnosis.update(std::array{x[0], x[1], x[2], x[3], x[4], x[5], std::sin(t)}, y, t);
  });
  ASSERT_EQ(diagnosis.health().size(), 3U);
  ASSERT_EQ(diagnosis.present().size(), 3U);
  EXPECT_EQ(diagnosis.present().back().place, 5U);
  EXPECT_THROW(Authority(diagnosis, {{6, -1.0, 1.0}}), InputError);
}

// Of more thrusters than there are sizes at once: nothing is known of the last.
TEST(Diagnosis, TellsTheHealthOfManyThrusters) {
  constexpr std::size_t kThrusters = 30;
  Diagnosis diagnosis(1 + kThrusters, {0}, {0});
  RandomStream random(1, "many");
  std::array<double, 1 + kThrusters> x{};
  for (int row = 0; row < 1800; ++row) {
    double thrust = 0.05;  // a constant force, which health allows for
    for (std::size_t i = 1; i < x.size(); ++i) {
      x[i] = random.uniform(-1.0, 1.0);
      thrust += 0.1 * x[i] * std::abs(x[i]);
    }
    const double a = thrust - 0.5 * x[0];
    diagnosis.update(x, std::array{a + 1e-3 * random.normal()}, 0.25 * row);
    x[0] += 0.25 * a;
  }
  ASSERT_EQ(diagnosis.health().size(), kThrusters);
  for (std::size_t i = 0; i < kThrusters; ++i) {
    const Cause& cause = diagnosis.health()[i];
    EXPECT_EQ(cause.place, 1 + i);
    EXPECT_NEAR(cause.size, 1.0, 0.1);
    EXPECT_EQ(std::isfinite(cause.upper), i < 23U) << i;
    EXPECT_LT(cause.lower, cause.upper);
  }
}

TEST(Diagnosis, NamesTwoCausesAtOnce) {
  const Diagnosis diagnosis = after({.thrust = {1.0, 0.6, 0.6}}, 4);
  ASSERT_EQ(diagnosis.findings().size(), 1U);
  const Finding& finding = diagnosis.findings().front();
  ASSERT_EQ(finding.state, FindingState::named);
  ASSERT_EQ(finding.count, 2U);
  EXPECT_EQ(finding.causes[0].place + finding.causes[1].place, 4U + 5U);
  EXPECT_NEAR(finding.causes[0].size, 0.6, 0.02);
  EXPECT_NEAR(finding.causes[1].size, 0.6, 0.02);
}

TEST(Diagnosis, FindsNothingWhereNothingChanges) {
  Diagnosis diagnosis = drive_diagnosis();
  Drive drive(5);
  drive.show(4 * kBefore, {}, diagnosis);
  EXPECT_EQ(diagnosis.found(), 0U);
  ASSERT_EQ(diagnosis.health().size(), 3U);
  for (const Cause& cause : diagnosis.health()) {
    EXPECT_LT(cause.lower, 1.01);
    EXPECT_GT(cause.upper, 0.99);
    EXPECT_NEAR(cause.size, 1.0, 0.03);
  }
}

// Both push alike and are driven alike: whose fault it is can't be told.
TEST(Diagnosis, SaysWhatItCannotTellApart) {
  const Diagnosis diagnosis =
      after({.thrust = {0.5, 1.0, 1.0}, .together = true}, 6, {.together = true});
  ASSERT_EQ(diagnosis.findings().size(), 1U);
  const Finding& finding = diagnosis.findings().front();
  EXPECT_EQ(finding.state, FindingState::ambiguous);
  const std::string text = finding_text(finding, {kInputs, kTargets});
  EXPECT_NE(text.find("th1"), std::string::npos) << text;
  EXPECT_NE(text.find("th3"), std::string::npos) << text;
  EXPECT_NE(text.find("not excited enough"), std::string::npos) << text;
}

TEST(Diagnosis, HasNoNameForWhatItDoesntKnow) {
  const Diagnosis diagnosis =
      after({.strange = [](double t) { return 0.05 * std::sin(1.3 * t); }}, 7);
  for (const Finding& finding : diagnosis.findings()) {
    EXPECT_NE(finding.state, FindingState::named) << finding_text(finding, {kInputs, kTargets});
  }
}

// A change is settled, and what comes back is a change as well.
TEST(Diagnosis, GoesOnFromAChange) {
  Diagnosis diagnosis = drive_diagnosis();
  Drive drive(8);
  drive.show(kBefore, {}, diagnosis);
  drive.show(5 * kMinute, {.thrust = {1.0, 0.5, 1.0}}, diagnosis);
  drive.show(kMinute, {}, diagnosis);
  ASSERT_EQ(diagnosis.findings().size(), 2U);
  EXPECT_TRUE(diagnosis.findings()[0].settled);
  EXPECT_NEAR(diagnosis.findings()[0].causes[0].size, 0.5, 0.01);
  EXPECT_EQ(diagnosis.findings()[1].causes[0].place, 4U);
  EXPECT_NEAR(diagnosis.findings()[1].causes[0].size, 1.0, 0.03);
  EXPECT_NEAR(diagnosis.findings()[1].before[0], 0.5, 0.01);
}

// Several times its last thrust would say nothing, the nominal thrust says all; also of what was
// saved.
TEST(Diagnosis, TellsTheNominalShareOfADeadThrusterThatComesBack) {
  Diagnosis diagnosis = drive_diagnosis();
  Drive drive(8);
  drive.show(kBefore, {}, diagnosis);
  drive.show(5 * kMinute, {.thrust = {1.0, 0.0, 1.0}}, diagnosis);
  drive.show(3 * kMinute, {}, diagnosis);
  Diagnosis loaded = drive_diagnosis();
  load(loaded, saved(diagnosis));
  for (const Diagnosis* const each : {&diagnosis, &loaded}) {
    const Finding& last = each->findings().back();
    ASSERT_EQ(last.state, FindingState::named);
    EXPECT_LE(last.causes[0].lower, 1.0);
    EXPECT_GE(last.causes[0].upper, 1.0);
    EXPECT_NEAR(last.causes[0].size, 1.0, 0.1);
    EXPECT_NEAR(last.before[0], 0.0, 0.01);
    EXPECT_NEAR(each->present()[1].size, last.causes[0].size, 1e-12);
    const std::string text = finding_text(last, {kInputs, kTargets});
    EXPECT_TRUE(text.starts_with("th2 gives ")) << text;
    EXPECT_NE(text.find(" % of its nominal thrust again ("), std::string::npos) << text;
    EXPECT_TRUE(text.ends_with("; before 0 %)")) << text;
  }
}

// A payload slows every acceleration; the thruster gives half of its thrust all the same.
TEST(Diagnosis, AShareOfThrustDoesNotCountALoadTwice) {
  Diagnosis diagnosis = drive_diagnosis();
  Drive drive(13);
  drive.show(kBefore, {}, diagnosis);
  drive.show(5 * kMinute, {.inertia = 1.5}, diagnosis);
  drive.show(2 * kMinute, {.thrust = {1.0, 0.5, 1.0}, .inertia = 1.5}, diagnosis);
  ASSERT_EQ(diagnosis.findings().size(), 2U);
  EXPECT_EQ(diagnosis.findings()[0].causes[0].kind, CauseKind::load);
  EXPECT_EQ(diagnosis.findings()[1].causes[0].place, 4U);
  EXPECT_NEAR(diagnosis.present()[1].size, 0.5, 0.02);
}

TEST(Diagnosis, ShrugsOffOutliersAndRowsThatArentNumbers) {
  Diagnosis diagnosis = drive_diagnosis();
  Drive drive(9);
  std::size_t row = 0;
  drive.show(2 * kBefore, {}, [&](Drive::Row x, Drive::Accelerations y, double t) {
    ++row;
    if (row % 50 == 0 && row > kBefore) {
      y[row % 3] += 5.0;
    }
    if (row % 37 == 0) {
      x[row % 6] = std::numeric_limits<double>::quiet_NaN();
    }
    diagnosis.update(x, y, t);
  });
  EXPECT_EQ(diagnosis.found(), 0U);
}

// Saved at rows in all its states: before a reference, amid windows, looking into a change.
TEST(Diagnosis, GoesOnFromWhatWasSavedToTheLastBit) {
  Diagnosis whole = drive_diagnosis();
  Diagnosis parts = drive_diagnosis();
  Drive drive(10);
  std::size_t row = 0;
  const auto show = [&](const Drive::Row& x, const Drive::Accelerations& y, double t) {
    whole.update(x, y, t);
    parts.update(x, y, t);
    if (++row % 113 == 0) {
      const std::string bytes = saved(parts);
      parts = drive_diagnosis();
      load(parts, bytes);
      ASSERT_EQ(saved(parts), saved(whole)) << row;
    }
  };
  drive.show(kBefore, {}, show);
  drive.show(3 * kMinute, {.thrust = {0.6, 1.0, 1.0}}, show);
  drive.show(kMinute, {.thrust = {0.6, 1.0, 1.0}, .frozen = true}, show);
  EXPECT_EQ(parts.findings().size(), 2U);
  EXPECT_EQ(saved(parts), saved(whole));
}

// Only so many findings are kept: the first, of the weak thruster, is gone.
TEST(Diagnosis, TheShareBeforeIsSavedHoweverManyFindingsFollowed) {
  Diagnosis diagnosis = drive_diagnosis();
  Drive drive(1);
  const Drive::Fault weak{.thrust = {0.5, 1.0, 1.0}};
  Drive::Fault flaky = weak;
  flaky.frozen = true;
  drive.show(kBefore, {}, diagnosis);
  drive.show(2 * kMinute, weak, diagnosis);
  for (std::size_t i = 0; i <= Diagnosis::kMostFindings; ++i) {
    drive.show(30, flaky, diagnosis);
    drive.show(20, weak, diagnosis);
  }
  drive.show(kBefore, weak, diagnosis);
  drive.show(2 * kMinute, {}, diagnosis);
  ASSERT_NEAR(diagnosis.findings().back().before[0], 0.5, 0.05);
  Diagnosis resumed = drive_diagnosis();
  load(resumed, saved(diagnosis));
  EXPECT_EQ(resumed.findings().back().before, diagnosis.findings().back().before);
}

TEST(Diagnosis, AnAbsurdSampleLeavesNoTrace) {
  Diagnosis whole = drive_diagnosis();
  Diagnosis struck = drive_diagnosis();
  struck.update(std::array{1e200, 0.0, 0.0, 1.0, 1.0, 1.0}, std::array{0.0, 0.0, 0.0}, 0.1);
  Drive drive(1);
  drive.show(kMinute, {}, [&](const Drive::Row& x, const Drive::Accelerations& y, double t) {
    whole.update(x, y, t);
    struck.update(x, y, t);
  });
  EXPECT_EQ(saved(struck), saved(whole));
}

TEST(Diagnosis, RefusesASavedStateThatIsCutShort) {
  Diagnosis diagnosis = after({.drag = 1.5}, 11);
  const std::string bytes = saved(diagnosis);
  for (const std::size_t length : {std::size_t{0}, bytes.size() / 3, bytes.size() - 1}) {
    Diagnosis fresh = drive_diagnosis();
    EXPECT_THROW(load(fresh, std::string_view(bytes).substr(0, length)), InputError);
  }
}

TEST(Diagnosis, AllocatesNothingOnceItStands) {
  KELPIE_NEEDS_ALLOCATION_COUNT();
  Diagnosis diagnosis = drive_diagnosis();
  Drive drive(12);
  std::size_t allocations = 0;
  const auto show = [&](const Drive::Row& x, const Drive::Accelerations& y, double t) {
    const std::size_t before = testing::allocations;
    diagnosis.update(x, y, t);
    allocations += testing::allocations - before;
  };
  drive.show(kBefore, {}, show);
  drive.show(3 * kMinute, {.drag = 1.5}, show);
  EXPECT_EQ(allocations, 0U);
  EXPECT_EQ(diagnosis.found(), 1U);
}

}  // namespace
}  // namespace kelpie::diagnosis_test
