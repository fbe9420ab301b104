// SPDX-License-Identifier: Apache-2.0
#include "study/open_loop_study.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "log/dataset.hpp"

namespace kelpie::open_loop_study_test {
namespace {

// ν' = command − ½ν for u and v, the yaw rate as commanded; exact at 4 Hz.
log::Dataset exact_log(std::size_t rows) {
  log::Dataset data;
  data.input_names = {"u", "v", "r", "cu", "cv", "cr"};
  data.target_names = {"udot", "vdot", "rdot"};
  double u = 0.3;
  double v = -0.1;
  for (std::size_t i = 0; i < rows; ++i) {
    const double t = 0.25 * static_cast<double>(i);
    const double cu = 0.2 + 0.1 * std::floor(std::fmod(t, 7.0));
    const double cv = 0.1 * std::floor(std::fmod(t, 5.0)) - 0.2;
    const double r = 0.3 * std::sin(0.2 * t);
    data.inputs.insert(data.inputs.end(), {u, v, r, cu, cv, r});
    data.targets.insert(data.targets.end(), {cu - 0.5 * u, cv - 0.5 * v, 0.06 * std::cos(0.2 * t)});
    data.times_s.push_back(t);
    data.configurations.push_back(0);
    u = 2.0 * cu + (u - 2.0 * cu) * std::exp(-0.125);
    v = 2.0 * cv + (v - 2.0 * cv) * std::exp(-0.125);
  }
  data.rate_hz = 4.0;
  return data;
}

OpenLoop exact_model() {
  OpenLoop loop;
  loop.accelerations = [](std::span<const double> x, std::span<double> a) {
    a[0] = x[3] - 0.5 * x[0];
    a[1] = x[4] - 0.5 * x[1];
    a[2] = 0.0;
  };
  loop.states = {0, 1, 2};
  loop.error = {0.0, 0.0, 0.0};
  loop.error_time_s = {0.0, 0.0, 0.0};
  loop.noise = {0.0, 0.0, 0.0};
  loop.seen.assign(6, {-3.0, 3.0});
  return loop;
}

std::vector<std::size_t> rows_from(std::size_t begin, std::size_t end) {
  std::vector<std::size_t> rows;
  for (std::size_t row = begin; row < end; ++row) {
    rows.push_back(row);
  }
  return rows;
}

TEST(OpenLoopStudy, StretchesEndAtGapsCutsAndOtherConfigurations) {
  log::Dataset data = exact_log(100);
  std::vector<std::size_t> rows = rows_from(10, 90);
  rows.erase(rows.begin() + 10);  // row 20 isn't held out
  for (std::size_t i = 40; i < 100; ++i) {
    data.times_s[i] += 1.0;  // four usual steps
  }
  for (std::size_t i = 60; i < 100; ++i) {
    data.inputs[6 * i] += 2.0;  // surge jumps
  }
  for (std::size_t i = 80; i < 100; ++i) {
    data.configurations[i] = 1;
  }
  const std::vector<study::Stretch> found =
      study::unbroken_stretches(data, rows, std::vector<std::size_t>{0, 1});
  const std::vector<std::pair<std::size_t, std::size_t>> expected{
      {10, 20}, {21, 40}, {40, 60}, {60, 80}, {80, 90}};
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(found[i].begin, expected[i].first);
    EXPECT_EQ(found[i].end, expected[i].second);
  }
}

TEST(OpenLoopStudy, APerfectModelIsNeverOffAndReckonsItsWay) {
  const log::Dataset data = exact_log(800);
  const std::vector<study::Stretch> stretches{{100, 700}};
  study::OpenLoopStudy study;
  study.rollout.between = CommandPath::held;
  study.rollout.step_s = 0.05;
  const study::OpenLoopScore score =
      study::score_open_loop("exact", exact_model(), data, stretches, study);
  ASSERT_EQ(score.horizons.size(), 4U);
  for (const study::HorizonScore& horizon : score.horizons) {
    // A start every second that has the horizon left before the stretch ends.
    EXPECT_EQ(horizon.starts, 150U - static_cast<std::size_t>(horizon.seconds));
    EXPECT_NEAR(horizon.r2[0], 1.0, 1e-9);
    EXPECT_LT(horizon.rms[1], 1e-6);
    EXPECT_EQ(horizon.beyond, 0.0);
  }
  ASSERT_EQ(score.reckoning.size(), 3U);
  for (const study::ReckoningScore& outage : score.reckoning) {
    EXPECT_LT(outage.most, 1e-6);
    EXPECT_GT(outage.outages, 2U);
  }
}

TEST(OpenLoopStudy, HeldVelocityIsOffByHowFarTheVehicleChanged) {
  const log::Dataset data = exact_log(400);
  study::OpenLoopStudy study;
  study.horizons_s = {5.0};
  const std::vector<study::Stretch> stretches{{0, 400}};
  const study::OpenLoopScore score =
      study::score_open_loop("held", study::hold_velocity(exact_model()), data, stretches, study);
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t row = 0; row + 20 < 400; row += 4, ++count) {
    const double change = data.input(row + 20)[0] - data.input(row)[0];
    sum += change * change;
  }
  EXPECT_EQ(score.horizons[0].starts, count);
  EXPECT_NEAR(score.horizons[0].rms[0], std::sqrt(sum / static_cast<double>(count)), 1e-12);
}

TEST(OpenLoopStudy, DeadReckoningAgainstACircleDrivenTooSlow) {
  // A circle of 0.5 m/s at 0.1 rad/s; the model believes 0.4 m/s. Both paths are circles from the
  // same start: the distance between their ends is 0.1 / 0.5 of the chord.
  log::Dataset data = exact_log(2);
  data.inputs.clear();
  data.times_s.clear();
  for (std::size_t i = 0; i < 400; ++i) {
    data.times_s.push_back(0.25 * static_cast<double>(i));
    data.inputs.insert(data.inputs.end(), {0.5, 0.0, 0.1, 0.0, 0.0, 0.0});
  }
  OpenLoop slow = exact_model();
  slow.accelerations = [](std::span<const double> x, std::span<double> a) {
    a[0] = 10.0 * (0.4 - x[0]);
    a[1] = a[2] = 0.0;
  };
  study::OpenLoopStudy study;
  study.horizons_s = {1.0};
  study.outages_s = {10.0};
  study.rollout.step_s = 0.05;
  const std::vector<study::Stretch> stretches{{0, 400}};
  const study::OpenLoopScore score = study::score_open_loop("slow", slow, data, stretches, study);
  const double chord = 2.0 * 5.0 * std::sin(0.5);
  EXPECT_NEAR(score.reckoning[0].median, 0.2 * chord / 5.0, 0.01);
}

}  // namespace
}  // namespace kelpie::open_loop_study_test
