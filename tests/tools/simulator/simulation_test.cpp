// SPDX-License-Identifier: Apache-2.0
#include "simulator/simulation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "fixtures.hpp"

namespace kelpie::simulation_test {
namespace {

simulator::Scenario short_scenario() {
  simulator::Scenario scenario;
  scenario.vehicle = testing::dagon();
  scenario.rate_hz = 4.0;
  scenario.noise = simulator::noise_preset("as_recorded");
  simulator::Configuration damaged;
  damaged.name = "damaged";
  damaged.effectiveness(simulator::kSurgeRight) = 0.5;
  scenario.configurations = {simulator::Configuration{}, damaged};
  scenario.phases = {{.configuration = 0, .duration_s = 60.0},
                     {.configuration = 1, .duration_s = 60.0}};
  return scenario;
}

bool same(const simulator::LogRow& a, const simulator::LogRow& b) {
  return a.t_s == b.t_s && a.configuration == b.configuration && a.velocity == b.velocity &&
         a.rotors_rps == b.rotors_rps && a.acceleration == b.acceleration &&
         a.true_acceleration == b.true_acceleration;
}

bool same(const std::vector<simulator::LogRow>& a, const std::vector<simulator::LogRow>& b) {
  return std::equal(
      a.begin(), a.end(), b.begin(), b.end(),
      [](const simulator::LogRow& x, const simulator::LogRow& y) { return same(x, y); });
}

TEST(Simulation, GivesEveryPhaseItsRows) {
  const auto rows = simulator::simulate(short_scenario());
  ASSERT_EQ(rows.size(), 480U);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_DOUBLE_EQ(rows[i].t_s, 0.25 * static_cast<double>(i + 1));
    EXPECT_EQ(rows[i].configuration, i < 240 ? 0U : 1U);
  }
}

TEST(Simulation, SameSeedSameBitsOtherSeedOtherBits) {
  simulator::Scenario scenario = short_scenario();
  const auto rows = simulator::simulate(scenario);
  EXPECT_TRUE(same(rows, simulator::simulate(scenario)));
  scenario.seed = 2;
  EXPECT_FALSE(same(rows, simulator::simulate(scenario)));
}

// A row waits for the window of its acceleration alone, so that a day's drive begins at once.
TEST(Simulation, RowsOneAtATimeAreTheSameAndComeAtOnce) {
  simulator::Scenario scenario = short_scenario();
  const simulator::RowSource drive = simulator::drive_in_plane(scenario);
  std::vector<simulator::LogRow> rows;
  while (std::optional<simulator::LogRow> row = drive()) {
    rows.push_back(*row);
  }
  EXPECT_TRUE(same(rows, simulator::simulate(scenario)));
  EXPECT_EQ(rows.size(), 480U);
  scenario.phases[0].duration_s = 400'000.0;
  EXPECT_TRUE(same(*simulator::drive_in_plane(scenario)(), rows.front()));
}

TEST(Simulation, NoiseLeavesCommandsAndMotionAsTheyWere) {
  simulator::Scenario scenario = short_scenario();
  const auto rows = simulator::simulate(scenario);
  for (const char* const preset : {"none", "raw_dvl", "stress"}) {
    scenario.noise = simulator::noise_preset(preset);
    const auto others = simulator::simulate(scenario);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      ASSERT_EQ(rows[i].rotors_rps, others[i].rotors_rps);
      ASSERT_EQ(rows[i].true_acceleration, others[i].true_acceleration);
      ASSERT_NE(rows[i].velocity, others[i].velocity);
    }
  }
}

TEST(Simulation, TheRateLeavesTheMotionAsItWas) {
  simulator::Scenario scenario = short_scenario();
  scenario.noise = simulator::noise_preset("none");
  const auto at_4_hz = simulator::simulate(scenario);
  scenario.rate_hz = 1.0;
  const auto at_1_hz = simulator::simulate(scenario);
  ASSERT_EQ(4 * at_1_hz.size(), at_4_hz.size());
  for (std::size_t i = 0; i < at_1_hz.size(); ++i) {
    EXPECT_TRUE(same(at_1_hz[i], at_4_hz[4 * i + 3]));
  }
}

TEST(Simulation, NavigationFilterComesNearTheTruth) {
  simulator::Scenario scenario = short_scenario();
  scenario.phases = {{.configuration = 0, .duration_s = 600.0}};
  const auto rows = simulator::simulate(scenario);
  Eigen::Vector3d errors = Eigen::Vector3d::Zero(), squares = Eigen::Vector3d::Zero();
  for (const simulator::LogRow& row : rows) {
    errors += (row.acceleration - row.true_acceleration).cwiseAbs2();
    squares += row.true_acceleration.cwiseAbs2();
  }
  EXPECT_GT(errors.maxCoeff(), 0.0);
  EXPECT_TRUE((errors.array() < 0.01 * squares.array()).all());
}

TEST(Simulation, AChangedConfigurationChangesTheMotionFromItsPhaseOn) {
  simulator::Scenario scenario = short_scenario();
  const auto changed = simulator::simulate(scenario);
  scenario.phases[1].configuration = 0;
  const auto unchanged = simulator::simulate(scenario);
  EXPECT_EQ(changed[239].true_acceleration, unchanged[239].true_acceleration);
  EXPECT_NE(changed[240].true_acceleration, unchanged[240].true_acceleration);
  EXPECT_EQ(changed[479].rotors_rps, unchanged[479].rotors_rps);
}

// Damping makes the vehicle forget how it got here, so that after the ramp it moves as one that
// was changed at once; while it ramps it doesn't.
TEST(Simulation, ARampEndsInTheConfigurationItGoesTo) {
  simulator::Scenario scenario = short_scenario();
  scenario.noise = simulator::noise_preset("none");
  scenario.phases[1].duration_s = 400.0;
  const auto at_once = simulator::simulate(scenario);
  scenario.phases[1].ramp_s = 100.0;
  const auto ramped = simulator::simulate(scenario);
  const auto difference = [&](std::size_t row) {
    return (at_once[row].velocity - ramped[row].velocity).norm();
  };
  EXPECT_EQ(difference(239), 0.0);
  EXPECT_GT(difference(300), 0.02);
  EXPECT_LT(difference(at_once.size() - 1), 1e-4);
  EXPECT_EQ(ramped[240].configuration, 1U);
}

TEST(Simulation, LowAmplitudeMeansSlowDriving) {
  simulator::Scenario scenario = short_scenario();
  scenario.phases = {{.configuration = 0, .duration_s = 300.0},
                     {.configuration = 0, .duration_s = 300.0, .amplitude = 0.2}};
  const auto rows = simulator::simulate(scenario);
  double fast = 0.0, slow = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    double& speed = i < rows.size() / 2 ? fast : slow;
    speed = std::max(speed, i % (rows.size() / 2) < 200 ? 0.0 : rows[i].velocity.head<2>().norm());
  }
  EXPECT_LT(slow, 0.3 * fast);
}

TEST(Simulation, CurrentMovesTheVehicleOverGround) {
  simulator::Scenario scenario = short_scenario();
  scenario.noise = simulator::noise_preset("none");
  scenario.current_m_s = {0.2, 0.0, 0.0};
  scenario.phases = {{.configuration = 0, .duration_s = 200.0, .amplitude = 0.0}};
  const Eigen::Vector3d drift = simulator::simulate(scenario).back().velocity;
  EXPECT_NEAR(drift.head<2>().norm(), 0.2, 1e-3);
}

TEST(Simulation, ProgressRisesToOne) {
  std::vector<double> shares;
  simulator::Scenario scenario = short_scenario();
  scenario.phases = {{.configuration = 0, .duration_s = 250.0}};
  simulator::simulate(scenario, [&](double share) { shares.push_back(share); });
  ASSERT_EQ(shares.size(), 3U);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_EQ(shares.back(), 1.0);
}

}  // namespace
}  // namespace kelpie::simulation_test
