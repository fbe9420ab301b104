// SPDX-License-Identifier: Apache-2.0
//
// Vehicles with any thrusters: the BlueROV2 frames, their battery and actuators, and the pilot.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "allocation_count.hpp"
#include "fixtures.hpp"
#include "kelpie/core/error.hpp"
#include "simulator/battery.hpp"
#include "simulator/decomposition.hpp"
#include "simulator/pilot.hpp"
#include "simulator/simulation.hpp"
#include "simulator/simulator.hpp"

namespace kelpie::six_axes_test {
namespace {

using simulator::RotorSpeeds;
using simulator::Vector6;

simulator::VehicleParameters heavy() {
  return simulator::read_vehicle(testing::source_file("vehicles/bluerov2_heavy.toml"));
}

simulator::VehicleParameters bluerov() {
  return simulator::read_vehicle(testing::source_file("vehicles/bluerov2.toml"));
}

simulator::Simulator simulator_of(const simulator::VehicleParameters& vehicle,
                                  const simulator::State& start = {}) {
  return {vehicle, testing::nominal(vehicle), Eigen::Vector3d::Zero(), start};
}

// Force and moment by hand, s = √½: the moment of a horizontal thruster about z is
// (0.156 + 0.111) s, about x and y 0.085 s by the height of its axis below the origin.
TEST(SixAxes, EachThrusterOfTheHeavyGivesTheWrenchComputedByHand) {
  const double s = std::sqrt(0.5);
  const double yaw = 0.267 * s, tilt = 0.085 * s;
  const std::vector<Vector6> wrenches = {
      (Vector6() << -s, s, 0.0, -tilt, -tilt, yaw).finished(),
      (Vector6() << -s, -s, 0.0, tilt, -tilt, -yaw).finished(),
      (Vector6() << s, s, 0.0, -tilt, tilt, -yaw).finished(),
      (Vector6() << s, -s, 0.0, tilt, tilt, yaw).finished(),
      (Vector6() << 0.0, 0.0, 1.0, 0.218, -0.12, 0.0).finished(),
      (Vector6() << 0.0, 0.0, 1.0, -0.218, -0.12, 0.0).finished(),
      (Vector6() << 0.0, 0.0, 1.0, 0.218, 0.12, 0.0).finished(),
      (Vector6() << 0.0, 0.0, 1.0, -0.218, 0.12, 0.0).finished()};
  const simulator::VehicleParameters vehicle = heavy();
  const simulator::Plant plant = testing::nominal(vehicle);
  const simulator::Dynamics dynamics(plant);
  ASSERT_EQ(vehicle.thrusters.size(), wrenches.size());
  const Vector6 idle = plant.mass * dynamics.acceleration(Eigen::Quaterniond::Identity(),
                                                          Vector6::Zero(), RotorSpeeds::Zero(8));
  for (Eigen::Index i = 0; i < 8; ++i) {
    const Vector6& wrench = wrenches[static_cast<std::size_t>(i)];
    EXPECT_LT((simulator::thrust_axes(vehicle.thrusters).col(i) - wrench).norm(), 1e-12) << i;
    // Through the equation of motion, forwards and in reverse, half of the greatest speed.
    for (const auto& [speed, newtons] :
         {std::pair{0.5, 51.5 / 4.0}, std::pair{-0.5, -40.2 / 4.0}}) {
      RotorSpeeds speeds = RotorSpeeds::Zero(8);
      speeds(i) = speed;
      const Vector6 acceleration =
          dynamics.acceleration(Eigen::Quaterniond::Identity(), Vector6::Zero(), speeds);
      EXPECT_LT((plant.mass * acceleration - idle - newtons * wrench).norm(), 1e-12) << i;
    }
  }
}

// ArduSub's table of the frame: the sign of each motor's effect on roll, pitch, yaw, throttle
// (upwards), forward and lateral.
TEST(SixAxes, MotorsPushAsArduSubsTableOfTheFrameSays) {
  const Eigen::Matrix<int, 8, 6> table{
      {0, 0, 1, 0, -1, 1},  {0, 0, -1, 0, -1, -1}, {0, 0, -1, 0, 1, 1}, {0, 0, 1, 0, 1, -1},
      {1, -1, 0, -1, 0, 0}, {-1, -1, 0, -1, 0, 0}, {1, 1, 0, -1, 0, 0}, {-1, 1, 0, -1, 0, 0}};
  const auto sign = [](double x) { return x > 1e-9 ? 1 : x < -1e-9 ? -1 : 0; };
  const simulator::ThrustAxes axes = simulator::thrust_axes(heavy().thrusters);
  for (Eigen::Index i = 0; i < 8; ++i) {
    const bool is_vertical = i >= 4;
    if (is_vertical) {
      EXPECT_EQ(sign(axes(3, i)), table(i, 0)) << i;
      EXPECT_EQ(sign(axes(4, i)), table(i, 1)) << i;
    }
    EXPECT_EQ(sign(axes(5, i)), table(i, 2)) << i;
    EXPECT_EQ(-sign(axes(2, i)), table(i, 3)) << i;
    EXPECT_EQ(sign(axes(0, i)), table(i, 4)) << i;
    EXPECT_EQ(sign(axes(1, i)), table(i, 5)) << i;
  }
  EXPECT_EQ(simulator::rank_of(axes), 6);
  EXPECT_EQ(simulator::rank_of(simulator::thrust_axes(bluerov().thrusters)), 5);
}

TEST(SixAxes, EnergyIsKeptWithoutDragAndNeverRisesWithDrag) {
  simulator::VehicleParameters vehicle = heavy();
  simulator::State start;
  start.velocity << 0.5, 0.2, 0.1, 0.3, 0.2, 0.4;
  {
    const simulator::Plant plant = testing::nominal(vehicle);
    simulator::State state = start;
    for (int step = 0; step < 2000; ++step) {
      const double before = testing::energy(plant, state);
      state = simulator::rk4_step(simulator::Dynamics(plant), state, {}, 0.01);
      ASSERT_LE(testing::energy(plant, state), before + 1e-9);
    }
  }
  vehicle.linear_damping.setZero();
  vehicle.quadratic_damping.setZero();
  vehicle.net_buoyancy_n = 0.0;  // else the vehicle gathers speed upwards without end
  const simulator::Plant plant = testing::nominal(vehicle);
  const simulator::State end = testing::after(simulator::Dynamics(plant), start, 100.0, 0.01);
  EXPECT_NEAR(testing::energy(plant, end), testing::energy(plant, start), 1e-6);
}

// At rest, level, four vertical thrusters against 2.44 N of buoyancy; tilted, the righting moment
// is B · 1 cm · sin, and weight less buoyancy acts along the world's vertical.
TEST(SixAxes, HoversWhereThrustEqualsBuoyancyAndRightsItself) {
  const simulator::VehicleParameters vehicle = heavy();
  const simulator::Plant plant = testing::nominal(vehicle);
  const simulator::Dynamics dynamics(plant);
  RotorSpeeds speeds = RotorSpeeds::Zero(8);
  speeds.tail<4>().setConstant(std::sqrt(2.44 / 4.0 / 51.5));
  EXPECT_LT(dynamics.acceleration(Eigen::Quaterniond::Identity(), Vector6::Zero(), speeds).norm(),
            1e-12);

  const double roll = 0.3;
  const double buoyancy = 13.5 * simulator::kGravity + 2.44;
  const Eigen::Quaterniond tilted(Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()));
  const Vector6 wrench =
      plant.mass * dynamics.acceleration(tilted, Vector6::Zero(), RotorSpeeds::Zero(8));
  EXPECT_NEAR(wrench(3), -buoyancy * 0.01 * std::sin(roll), 1e-12);
  EXPECT_NEAR(wrench(1), -2.44 * std::sin(roll), 1e-12);
  EXPECT_NEAR(wrench(2), -2.44 * std::cos(roll), 1e-12);
}

TEST(SixAxes, AccelerationIsTheSlopeOfTheVelocityOnEveryAxis) {
  simulator::VehicleParameters vehicle = heavy();
  vehicle.rotor_delay_s = 0.0;
  simulator::Simulator simulator = simulator_of(vehicle);
  const RotorSpeeds commands{{0.6, -0.4, 0.5, 0.3, 0.35, -0.3, 0.2, 0.4}};
  for (int tick = 0; tick < 300; ++tick) {
    simulator.advance(commands);
  }
  for (int i = 0; i < 50; ++i) {
    const Vector6 before = simulator.state().velocity;
    simulator.advance(commands);
    const Vector6 acceleration = simulator.acceleration();
    simulator.advance(commands);
    const Vector6 slope = (simulator.state().velocity - before) / (2.0 * simulator::kTickS);
    EXPECT_LT((slope - acceleration).cwiseAbs().maxCoeff(), 2e-3);
  }
}

TEST(SixAxes, SteadySurgeSpeedIsWhereThrustAtThisVoltageEqualsDrag) {
  simulator::VehicleParameters vehicle = heavy();
  vehicle.centre_of_buoyancy_m.z() = -10.0;  // stiff in roll and pitch: the thrust is low
  vehicle.net_buoyancy_n = 0.0;
  vehicle.linear_damping.tail<3>().setConstant(50.0);
  vehicle.battery.capacity_ah = 1e6;
  simulator::Simulator simulator = simulator_of(vehicle);
  RotorSpeeds commands = RotorSpeeds::Zero(8);
  commands.head<4>() << -0.5, -0.5, 0.5, 0.5;
  for (int tick = 0; tick < 6000; ++tick) {
    simulator.advance(commands);
  }
  const double n = (0.5 - 0.0625) / (1.0 - 0.0625);
  const double factor = std::pow(simulator.voltage_v() / 16.0, 1.2);
  const double push = 2.0 * std::sqrt(0.5) * (51.5 + 40.2) * n * n * factor;
  const double speed = (-13.7 + std::sqrt(13.7 * 13.7 + 4.0 * 141.0 * push)) / (2.0 * 141.0);
  EXPECT_NEAR(simulator.state().velocity(0), speed, 0.01 * speed);
}

TEST(Actuators, TheDeadBandStopsTheRotorAndFullCommandIsFullSpeed) {
  simulator::Thruster thruster;
  thruster.max_speed_rps = 1.0;
  thruster.dead_band = 0.1;
  EXPECT_EQ(simulator::speed_for_command(thruster, 0.1), 0.0);
  EXPECT_EQ(simulator::speed_for_command(thruster, -0.05), 0.0);
  EXPECT_DOUBLE_EQ(simulator::speed_for_command(thruster, 1.0), 1.0);
  EXPECT_DOUBLE_EQ(simulator::speed_for_command(thruster, -0.55), -0.5);
  for (const double speed : {-1.0, -0.2, 0.01, 0.7}) {
    EXPECT_NEAR(
        simulator::speed_for_command(thruster, simulator::command_for_speed(thruster, speed)),
        speed, 1e-15);
  }
}

TEST(Actuators, CommandsTakeTheirDelayAndRotorsTheirRate) {
  simulator::VehicleParameters vehicle = heavy();
  vehicle.rotor_delay_s = 0.05;
  vehicle.rotor_lag_s = 0.0;
  vehicle.rotor_rate = 2.0;
  simulator::Simulator simulator = simulator_of(vehicle);
  for (int tick = 1; tick <= 60; ++tick) {
    simulator.advance(RotorSpeeds::Ones(8));
    const double expected = std::clamp(0.02 * (tick - 5), 0.0, 1.0);
    EXPECT_NEAR(simulator.state().rotors_rps(3), expected, 1e-12) << tick;
  }
  vehicle.rotor_lag_s = 0.1;
  simulator::Simulator lagging = simulator_of(vehicle);
  double last = 0.0;
  for (int tick = 1; tick <= 200; ++tick) {
    lagging.advance(RotorSpeeds::Ones(8));
    const double now = lagging.state().rotors_rps(0);
    EXPECT_LE(now - last, 0.02 + 1e-12);
    last = now;
  }
  EXPECT_NEAR(last, 1.0, 1e-4);
}

TEST(Battery, SagsByItsResistanceAndWithItsCharge) {
  const simulator::BatteryParameters cells{.nominal_v = 16.0,
                                           .full_v = 16.8,
                                           .empty_v = 13.2,
                                           .resistance_ohm = 0.04,
                                           .capacity_ah = 1.0,
                                           .thruster_w = 390.0,
                                           .idle_w = 0.0,
                                           .exponent = 1.2};
  simulator::Battery battery(cells);
  EXPECT_DOUBLE_EQ(battery.voltage_v(), 16.8);
  battery.draw(500.0, 0.01);
  const double current = 500.0 / battery.voltage_v();
  EXPECT_NEAR(battery.voltage_v(), 16.8 - 0.04 * current, 1e-9);
  EXPECT_NEAR(battery.thrust_factor(), std::pow(battery.voltage_v() / 16.0, 1.2), 1e-12);

  simulator::Battery other(cells);
  for (int second = 0; second < 1800; ++second) {  // 1 A of 1 Ah for half an hour
    other.draw(other.voltage_v(), 1.0);
  }
  other.draw(0.0, 0.0);
  EXPECT_NEAR(other.voltage_v(), 0.5 * (16.8 + 13.2), 1e-3);
  other.draw(1e9, 0.01);  // more than the cells can give
  EXPECT_TRUE(std::isfinite(other.voltage_v()));
  EXPECT_EQ(simulator::Battery({}).thrust_factor(), 1.0);
}

TEST(Battery, OneThrusterAtFullDrawsItsPower) {
  const simulator::VehicleParameters vehicle = heavy();
  RotorSpeeds speeds = RotorSpeeds::Zero(8);
  speeds(2) = 1.0;
  EXPECT_NEAR(simulator::thruster_power_w(vehicle, speeds, 1.0), 390.0, 1e-9);
  EXPECT_NEAR(simulator::thruster_power_w(vehicle, speeds, 0.25), 390.0 / 8.0, 1e-9);
  speeds(2) = -1.0;
  EXPECT_NEAR(simulator::thruster_power_w(vehicle, speeds, 1.0), 390.0 * std::pow(40.2 / 51.5, 1.5),
              1e-9);
}

simulator::Scenario drive_of(const simulator::VehicleParameters& vehicle,
                             simulator::ExcitationMode mode, double duration_s) {
  simulator::Scenario scenario;
  scenario.vehicle = vehicle;
  scenario.rate_hz = 20.0;
  scenario.log = simulator::LogKind::six;
  scenario.excitation = {.mode = mode,
                         .shortest_period_s = 1.0,
                         .longest_period_s = 6.0,
                         .effort = (Vector6() << 50, 50, 40, 6, 6, 4).finished(),
                         .dither = 0.1};
  scenario.configurations = {simulator::Configuration{}};
  scenario.phases = {{.configuration = 0, .duration_s = duration_s}};
  return scenario;
}

// Every mode moves every axis and every motor, keeps depth and stays upright.
TEST(Pilot, DrivesAllSixAxesAndAllMotors) {
  for (const auto mode : {simulator::ExcitationMode::prbs, simulator::ExcitationMode::steps,
                          simulator::ExcitationMode::pilot}) {
    const auto rows = simulator::simulate_six_axes(drive_of(heavy(), mode, 120.0));
    ASSERT_EQ(rows.size(), 2400U);
    Vector6 squares = Vector6::Zero();
    double steepest = 0.0;
    Eigen::Matrix<double, 8, 1> least = rows[0].commands, most = rows[0].commands;
    for (const simulator::SixAxisRow& row : rows) {
      squares += row.velocity.cwiseAbs2();
      steepest = std::max(steepest, row.attitude_rad.head<2>().cwiseAbs().maxCoeff());
      least = least.cwiseMin(row.commands);
      most = most.cwiseMax(row.commands);
      EXPECT_LE(row.voltage_v, 16.8);
    }
    const Vector6 rms = (squares / 2400.0).cwiseSqrt();
    EXPECT_GT(rms.minCoeff(), 0.05) << rms.transpose();
    EXPECT_LT(steepest, 1.5);
    EXPECT_GT((most - least).minCoeff(), 200.0);  // µs
    EXPECT_GE(least.minCoeff(), 1100.0);
    EXPECT_LE(most.maxCoeff(), 1900.0);
    EXPECT_LT(rows.back().voltage_v, 16.8);
  }
}

TEST(Pilot, AsksForTheWrenchOfItsWishes) {
  simulator::VehicleParameters vehicle = heavy();
  vehicle.hold = {};
  vehicle.command_unit = simulator::CommandUnit::share;
  const simulator::ExcitationSettings settings{
      .mode = simulator::ExcitationMode::prbs,
      .shortest_period_s = 5.0,
      .longest_period_s = 6.0,
      .effort = (Vector6() << 20, 15, 10, 1, 2, 3).finished()};
  simulator::Pilot pilot(vehicle, settings, 1);
  const RotorSpeeds commands = pilot.advance(simulator::State{}, simulator::kTickS, 1.0);
  Vector6 wrench = Vector6::Zero();
  for (Eigen::Index i = 0; i < 8; ++i) {
    const simulator::Thruster& thruster = vehicle.thrusters[static_cast<std::size_t>(i)];
    wrench += simulator::thrust(thruster, simulator::speed_for_command(thruster, commands(i))) *
              simulator::thrust_axis(thruster);
  }
  EXPECT_LT((wrench.cwiseAbs() - settings.effort).norm(), 1e-9) << wrench.transpose();
}

TEST(Pilot, SameSeedSameBitsAndNoiseOrFaultsLeaveTheWishes) {
  simulator::Scenario scenario = drive_of(heavy(), simulator::ExcitationMode::pilot, 20.0);
  const auto rows = simulator::simulate_six_axes(scenario);
  const auto again = simulator::simulate_six_axes(scenario);
  scenario.noise = simulator::noise_preset("raw_dvl");
  const auto noisy = simulator::simulate_six_axes(scenario);
  scenario.configurations[0].effectiveness(2) = 0.5;
  const auto faulty = simulator::simulate_six_axes(scenario);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ASSERT_EQ(rows[i].velocity, again[i].velocity);
    ASSERT_EQ(rows[i].commands, noisy[i].commands);
    ASSERT_EQ(rows[i].true_acceleration, noisy[i].true_acceleration);
    ASSERT_NE(rows[i].velocity, noisy[i].velocity);
  }
  EXPECT_NE(rows.back().true_acceleration, faulty.back().true_acceleration);
}

TEST(SixAxes, TheFilterOfTheSixAxesComesNearTheTruth) {
  const auto rows =
      simulator::simulate_six_axes(drive_of(heavy(), simulator::ExcitationMode::pilot, 60.0));
  Vector6 errors = Vector6::Zero(), squares = Vector6::Zero();
  for (const simulator::SixAxisRow& row : rows) {
    errors += (row.acceleration - row.true_acceleration).cwiseAbs2();
    squares += row.true_acceleration.cwiseAbs2();
  }
  EXPECT_TRUE((errors.array() < 0.1 * squares.array()).all())
      << errors.cwiseQuotient(squares).transpose();
}

TEST(SixAxes, ATickAllocatesNothing) {
  KELPIE_NEEDS_ALLOCATION_COUNT();
  const simulator::VehicleParameters vehicle = heavy();
  const simulator::Scenario scenario = drive_of(vehicle, simulator::ExcitationMode::pilot, 1.0);
  simulator::Pilot pilot(vehicle, scenario.excitation, 1);
  simulator::Simulator simulator = simulator_of(vehicle);
  const std::size_t before = testing::allocations;
  for (int tick = 0; tick < 1000; ++tick) {
    simulator.advance(pilot.advance(simulator.state(), simulator::kTickS, 1.0));
  }
  EXPECT_EQ(testing::allocations - before, 0U);
}

TEST(SixAxes, ADriveInThePlaneNeedsThePlanarThrusters) {
  simulator::Scenario scenario = drive_of(heavy(), simulator::ExcitationMode::pilot, 1.0);
  EXPECT_NO_THROW(scenario.validate());
  EXPECT_THROW(simulator::simulate(scenario), InputError);
  scenario.excitation.mode = simulator::ExcitationMode::independent;
  EXPECT_THROW(scenario.validate(), InputError);
  // Dagon logs all six axes as well.
  scenario.vehicle = testing::dagon();
  const auto rows = simulator::simulate_six_axes(scenario);
  EXPECT_EQ(rows.back().commands.size(), 5);
  EXPECT_EQ(rows.back().voltage_v, 0.0);
}

}  // namespace
}  // namespace kelpie::six_axes_test
