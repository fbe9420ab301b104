// SPDX-License-Identifier: Apache-2.0
#include "kelpie/motion/diagnosis.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "allocation_count.hpp"
#include "kelpie/core/error.hpp"
#include "motion/drive.hpp"

namespace kelpie::diagnosis_test {
namespace {

using testing::Drive;
using testing::drive_diagnosis;

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

std::string saved(Diagnosis& diagnosis) {
  Archive archive;
  diagnosis.visit(archive);
  return archive.bytes();
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
  const std::string bytes = saved(diagnosis);
  Diagnosis loaded = drive_diagnosis();
  Archive archive(bytes);
  loaded.visit(archive);
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
      Diagnosis next = drive_diagnosis();
      Archive archive(bytes);
      next.visit(archive);
      archive.finish();
      parts = std::move(next);
      ASSERT_EQ(saved(parts), saved(whole)) << row;
    }
  };
  drive.show(kBefore, {}, show);
  drive.show(3 * kMinute, {.thrust = {0.6, 1.0, 1.0}}, show);
  drive.show(kMinute, {.thrust = {0.6, 1.0, 1.0}, .frozen = true}, show);
  EXPECT_EQ(parts.findings().size(), 2U);
  EXPECT_EQ(saved(parts), saved(whole));
}

TEST(Diagnosis, RefusesASavedStateThatIsCutShort) {
  Diagnosis diagnosis = after({.drag = 1.5}, 11);
  const std::string bytes = saved(diagnosis);
  for (const std::size_t length : {std::size_t{0}, bytes.size() / 3, bytes.size() - 1}) {
    Diagnosis fresh = drive_diagnosis();
    Archive archive(std::string_view(bytes).substr(0, length));
    EXPECT_THROW(fresh.visit(archive), InputError);
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
