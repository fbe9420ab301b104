// SPDX-License-Identifier: Apache-2.0
#include "study/six_axes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "kelpie/core/error.hpp"
#include "simulator/dynamics.hpp"
#include "simulator/fixtures.hpp"
#include "simulator/scenario_file.hpp"
#include "simulator/simulation.hpp"

namespace kelpie::six_axes_test {
namespace {

simulator::Scenario heavy(double duration_s, std::uint64_t seed) {
  simulator::Scenario scenario =
      simulator::read_scenario(testing::source_file("scenarios/bluerov2_heavy.toml"));
  scenario.phases.front().duration_s = duration_s;
  scenario.seed = seed;
  return scenario;
}

SixAxisRows rows_of(const simulator::Scenario& scenario) {
  return study::six_axis_rows(simulator::simulate_six_axes(scenario), scenario.vehicle);
}

void expect_the_simulators_equation(const simulator::VehicleParameters& vehicle,
                                    RandomStream& stream) {
  SixAxisFit fit;
  fit.thrusters = study::six_axis_rows({}, vehicle).thrusters;
  for (const double value : study::six_axis_truth(vehicle)) {
    fit.parameters.push_back({.name = "", .value = value});
  }
  const simulator::Dynamics dynamics(testing::nominal(vehicle));
  for (int trial = 0; trial < 20; ++trial) {
    const simulator::State state = testing::random_state(stream);
    simulator::RotorSpeeds speeds(8);
    for (double& speed : speeds) {
      speed = stream.uniform(-1.0, 1.0);
    }
    const simulator::Vector6 truth = dynamics.acceleration(state.attitude, state.velocity, speeds);
    const Eigen::Vector3d down = state.attitude.conjugate() * Eigen::Vector3d::UnitZ();
    const SixVector found =
        fit.acceleration(std::span<const double, 6>(state.velocity.data(), 6),
                         std::span<const double, 3>(down.data(), 3), std::span(speeds.data(), 8));
    for (std::size_t axis = 0; axis < kSixAxes; ++axis) {
      EXPECT_NEAR(found[axis], truth(static_cast<Eigen::Index>(axis)), 1e-9) << axis;
    }
  }
}

// The simulator is checked against DART; the two share no code but Eigen. A centre of gravity low
// and forward at once has a product of inertia, which the structure lacks.
TEST(SixAxes, TheEquationIsThatOfTheSimulator) {
  RandomStream stream(5, "six axes");
  simulator::VehicleParameters vehicle = heavy(10.0, 1).vehicle;
  vehicle.centre_of_buoyancy_m = {-0.02, 0.01, -0.04};
  for (const Eigen::Vector3d& centre :
       {Eigen::Vector3d(0.0, 0.0, 0.05), Eigen::Vector3d(0.03, 0.0, 0.0)}) {
    vehicle.centre_of_gravity_m = centre;
    expect_the_simulators_equation(vehicle, stream);
  }
}

// Simulation, one seed; docs/howto/identify.md has twenty.
TEST(MeasuredSixAxes, TenMinutesOfASimulatedVehicleTellItsParameters) {
  const simulator::Scenario scenario = heavy(600.0, 11);
  const SixAxisFit fit = scaled_by_inertia(fit_six_axes(rows_of(scenario)),
                                           testing::nominal(scenario.vehicle).mass(0, 0), 0.0);
  const std::vector<double> truth = study::six_axis_truth(scenario.vehicle);
  ASSERT_EQ(fit.parameters.size(), truth.size());
  std::size_t inside = 0;
  std::size_t told = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const FittedParameter& found = fit.parameters[i];
    if (found.state == ParameterState::not_told || found.state == ParameterState::known) {
      continue;
    }
    ++told;
    const double off = std::abs(found.value - truth[i]);
    inside += off <= 1.645 * found.error ? 1 : 0;
    if (truth[i] != 0.0 && i < SixAxisPlace::curve(8)) {
      EXPECT_LT(off, 0.05 * std::abs(truth[i])) << found.name << " " << found.value;
    }
  }
  EXPECT_GE(told, 42U);
  EXPECT_GE(static_cast<double>(inside), 0.7 * static_cast<double>(told));
  EXPECT_NEAR(fit.curve.dead_band, 0.0625, 0.005);
  EXPECT_NEAR(fit.curve.exponent, 1.2, 0.1);
  EXPECT_NEAR(fit.curve.lag_s + fit.curve.delay_s, 0.1, 0.03);
}

TEST(SixAxes, WhatNeverMovedIsNotTold) {
  SixAxisRows rows = rows_of(heavy(300.0, 3));
  for (std::size_t i = 0; i < rows.commands.size(); i += 8) {
    rows.commands[i] = std::abs(rows.commands[i]);  // m1 never runs in reverse
  }
  rows.volts.clear();
  const SixAxisFit fit = fit_six_axes(rows);
  EXPECT_EQ(fit.parameters[SixAxisPlace::thruster(0) + 1].state, ParameterState::not_told);
  EXPECT_EQ(fit.parameters.back().state, ParameterState::not_told) << "no supply, no exponent";
  SixAxisRows few = rows;
  few.times_s.resize(40);
  EXPECT_THROW(fit_six_axes(few), InputError);
}

}  // namespace
}  // namespace kelpie::six_axes_test
