// SPDX-License-Identifier: Apache-2.0
#include "study/certificate.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "identify/six_axis_fit.hpp"
#include "simulator/dynamics.hpp"
#include "simulator/fixtures.hpp"
#include "simulator/scenario_file.hpp"
#include "simulator/simulation.hpp"
#include "study/six_axes.hpp"

namespace kelpie::certificate_test {
namespace {

simulator::Scenario heavy() {
  simulator::Scenario scenario =
      simulator::read_scenario(testing::source_file("scenarios/bluerov2_heavy.toml"));
  scenario.phases.front().duration_s = 120.0;
  return scenario;
}

// The simulated drive with the vehicle's own thrusts.
study::RecordedDrive drive_of(const simulator::Scenario& scenario) {
  const simulator::VehicleParameters& vehicle = scenario.vehicle;
  study::RecordedDrive drive{.starts = {0}, .rows_text = "simulated rows"};
  const std::vector<simulator::SixAxisRow> log = simulator::simulate_six_axes(scenario);
  for (const simulator::SixAxisRow& row : log) {
    drive.times_s.push_back(row.t_s);
    drive.velocities.push_back(row.velocity);
    drive.attitudes.push_back(Eigen::AngleAxisd(row.attitude_rad(1), Eigen::Vector3d::UnitY()) *
                              Eigen::AngleAxisd(row.attitude_rad(0), Eigen::Vector3d::UnitX()));
  }
  const SixAxisRows rows = study::six_axis_rows(log, vehicle);
  const std::vector<double> speeds =
      thruster_speeds(rows, {.lag_s = vehicle.rotor_lag_s,
                             .delay_s = vehicle.rotor_delay_s,
                             .dead_band = vehicle.thrusters.front().dead_band,
                             .exponent = vehicle.battery.exponent});
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    simulator::Vector6 force = simulator::Vector6::Zero();
    for (std::size_t k = 0; k < vehicle.thrusters.size(); ++k) {
      const simulator::Thruster& thruster = vehicle.thrusters[k];
      force += simulator::thrust(thruster, speeds[8 * row + k]) * simulator::thrust_axis(thruster);
    }
    drive.forces.push_back(force);
  }
  return drive;
}

class CertificateOfTheHeavy : public ::testing::Test {
 protected:
  static const study::Certificate& of(const char* name) {
    static const simulator::Scenario scenario = heavy();
    static const study::CertificateList list = study::certify(
        simulator::engines(),
        simulator::engine_body(scenario.vehicle, {true, true, true, true, true, true}),
        drive_of(scenario));
    for (const study::Certificate& one : list.engines) {
      if (one.engine.name == name) {
        return one;
      }
    }
    ADD_FAILURE() << name;
    return list.engines.front();
  }
};

TEST_F(CertificateOfTheHeavy, EnginesWithTheWholeEquationDriveTheLogAgain) {
  for (const char* const name : {"kelpie", "gazebo", "python_vehicle_simulator"}) {
    const study::Certificate& certificate = of(name);
    EXPECT_TRUE(certificate.limit.stable) << name;
    ASSERT_EQ(certificate.horizons.size(), 3U);
    EXPECT_GT(certificate.horizons[2].starts, 5U);
    for (const study::DrivenHorizon& horizon : certificate.horizons) {
      for (std::size_t axis = 0; axis < 6; ++axis) {
        EXPECT_GT(horizon.r2[axis], 0.9) << name << " " << horizon.seconds << " s, axis " << axis;
      }
    }
  }
}

// Heave: 18.7 kg of added mass on 13.5 kg.
TEST_F(CertificateOfTheHeavy, ThePluginsAddedMassIsToBlame) {
  const study::Certificate& plugin = of("gazebo_plugin");
  EXPECT_FALSE(plugin.limit.stable);
  EXPECT_FALSE(plugin.limit.largest_s.has_value());
  EXPECT_EQ(plugin.limit.term, simulator::EngineTerm::added_mass);
  EXPECT_EQ(simulator::axis_text(plugin.limit.axis), "heave");
  EXPECT_LT(plugin.horizons[1].r2[2], 0.0);
  EXPECT_TRUE(of("uuv_simulator").limit.stable) << "the filter moves the bound to 5.7 masses";
}

// 0.4 + 0.2 is above 0.6 in binary: a start after every fourth row all the same.
TEST_F(CertificateOfTheHeavy, RoundingSkipsNoStart) {
  const simulator::Scenario scenario = heavy();
  study::RecordedDrive drive = drive_of(scenario);
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    drive.times_s[row] = static_cast<double>(row) / 20.0;
  }
  const study::CertificateList list =
      study::certify(simulator::engines().first(1),
                     simulator::engine_body(scenario.vehicle, {true, true, true, true, true, true}),
                     drive, {.horizons_s = {0.5, 0.75, 1.0}, .start_every_s = 0.2});
  const std::size_t last = drive.rows() - 21;  // whose rollout of 1 s ends in the log
  EXPECT_NEAR(static_cast<double>(list.engines.front().horizons[2].starts),
              static_cast<double>(last / 4 + 1), 1.0);
}

TEST_F(CertificateOfTheHeavy, TheMeanOfAddedMassesCostsHeave) {
  EXPECT_LT(of("stonefish").horizons[0].r2[2], of("kelpie").horizons[0].r2[2]);
}

}  // namespace
}  // namespace kelpie::certificate_test
