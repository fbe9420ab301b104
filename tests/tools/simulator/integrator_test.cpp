// SPDX-License-Identifier: Apache-2.0
#include "simulator/integrator.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "fixtures.hpp"
#include "simulator/frames.hpp"

namespace kelpie::integrator_test {
namespace {

using testing::energy;

simulator::State tumbling() {
  simulator::State state;
  state.velocity << 0.5, 0.2, 0.1, 0.3, 0.2, 0.4;
  return state;
}

double relative_drift(const simulator::Plant& plant, const simulator::State& start, double step_s) {
  const simulator::State end = testing::after(simulator::Dynamics(plant), start, 100.0, step_s);
  return std::abs(energy(plant, end) - energy(plant, start)) /
         (0.5 * start.velocity.dot(plant.mass * start.velocity));
}

TEST(Integrator, KeepsTheEnergyWithoutDamping) {
  const double drift =
      relative_drift(testing::nominal(testing::lossless_dagon()), tumbling(), 0.01);
  RecordProperty("relative_drift", std::to_string(drift));
  EXPECT_LE(drift, 1e-7);
}

TEST(Integrator, EnergyDriftFallsWithTheFifthPowerOfTheStep) {
  const simulator::Plant plant = testing::nominal(testing::lossless_dagon());
  const double coarse = relative_drift(plant, tumbling(), 0.04);
  const double middle = relative_drift(plant, tumbling(), 0.02);
  const double fine = relative_drift(plant, tumbling(), 0.01);
  EXPECT_NEAR(coarse / middle, 32.0, 4.0);
  EXPECT_NEAR(middle / fine, 32.0, 4.0);
}

// dE/dt = τᵀν − νᵀD(ν)ν, for vehicles with every axis coupled.
TEST(Integrator, EnergyChangesByWhatThrustersGiveAndDampingTakes) {
  RandomStream stream(1, "power");
  constexpr double kStepS = 1e-4;
  for (int i = 0; i < 20; ++i) {
    const simulator::Plant plant = testing::nominal(testing::coupled_vehicle(stream));
    const simulator::Dynamics dynamics(plant);
    simulator::State state = testing::random_state(stream);
    state.rotors_rps = testing::random_vector<simulator::kPlanarThrusterCount>(stream, 10.0);
    const simulator::RotorDrive drive{.commands_rps = state.rotors_rps, .lag_s = 0.0};
    const double rate = (energy(plant, simulator::rk4_step(dynamics, state, drive, kStepS)) -
                         energy(plant, simulator::rk4_step(dynamics, state, drive, -kStepS))) /
                        (2.0 * kStepS);

    simulator::Vector6 thrust_forces = simulator::Vector6::Zero();
    for (Eigen::Index j = 0; j < state.rotors_rps.size(); ++j) {
      const double n = state.rotors_rps(j);
      thrust_forces += (n > 0 ? plant.forward(j) : plant.reverse(j)) * n * std::abs(n) *
                       plant.thrust_axes.col(j);
    }
    const simulator::Vector6& velocity = state.velocity;
    const double lost = velocity.cwiseAbs2().dot(plant.linear_damping) +
                        velocity.cwiseAbs().array().cube().matrix().dot(plant.quadratic_damping);
    EXPECT_NEAR(rate, thrust_forces.dot(velocity) - lost, 1e-5);
  }
}

TEST(Integrator, EnergyNeverRisesUnforced) {
  RandomStream stream(2, "passive");
  for (int i = 0; i < 10; ++i) {
    const simulator::Plant plant = testing::nominal(testing::coupled_vehicle(stream));
    const simulator::Dynamics dynamics(plant);
    simulator::State state = testing::random_state(stream);
    for (int step = 0; step < 1000; ++step) {
      const double before = energy(plant, state);
      state = simulator::rk4_step(dynamics, state, simulator::RotorDrive{}, 0.01);
      ASSERT_LE(energy(plant, state), before + 1e-9);
    }
  }
}

TEST(Integrator, StaysAtRestWhenWeightIsBuoyancy) {
  const simulator::State end =
      testing::after(simulator::Dynamics(testing::nominal(testing::lossless_dagon())),
                     simulator::State{}, 10.0, 0.01);
  EXPECT_EQ(end.velocity, simulator::Vector6::Zero());
  EXPECT_EQ(end.position_m, Eigen::Vector3d::Zero());
}

TEST(Integrator, RollsLikeAPendulum) {
  const simulator::VehicleParameters vehicle = testing::lossless_dagon();
  const simulator::Dynamics dynamics(testing::nominal(vehicle));
  simulator::State state;
  state.attitude = Eigen::AngleAxisd(0.01, Eigen::Vector3d::UnitX());
  constexpr double kStepS = 0.001;
  double last = 0.0;
  std::vector<double> crossings;
  for (int step = 1; crossings.size() < 11; ++step) {
    state = simulator::rk4_step(dynamics, state, simulator::RotorDrive{}, kStepS);
    if (const double rate = state.velocity(3); step > 1 && (last < 0.0) != (rate < 0.0)) {
      crossings.push_back((step - rate / (rate - last)) * kStepS);
    }
    last = state.velocity(3);
  }
  const double period = (crossings.back() - crossings.front()) / 5.0;
  const double expected = 2.0 * std::numbers::pi * std::sqrt((2.0 + 1.0) / (70.0 * 9.81 * 0.05));
  EXPECT_NEAR(period, expected, 0.02 * expected);  // sway moves along a little
}

TEST(Integrator, MirrorsPortAndStarboard) {
  simulator::VehicleParameters vehicle = testing::dagon();
  vehicle.thrusters[simulator::kSway].reverse = vehicle.thrusters[simulator::kSway].forward;
  const simulator::Dynamics dynamics(testing::nominal(vehicle));
  simulator::RotorDrive drive{.commands_rps = simulator::RotorSpeeds(5), .lag_s = 0.2};
  drive.commands_rps << 12.0, -7.0, 5.0, 3.0, -2.0;
  simulator::RotorDrive mirrored = drive;
  mirrored.commands_rps << -7.0, 12.0, -5.0, 3.0, -2.0;
  simulator::State start, mirrored_start;
  start.velocity << 0.3, 0.1, -0.05, 0.2, 0.1, -0.4;
  mirrored_start.velocity << 0.3, -0.1, -0.05, -0.2, 0.1, 0.4;

  const simulator::State end = testing::after(dynamics, start, 20.0, 0.01, drive);
  const simulator::State image = testing::after(dynamics, mirrored_start, 20.0, 0.01, mirrored);
  const simulator::Vector6 sign = (simulator::Vector6() << 1, -1, 1, -1, 1, -1).finished();
  EXPECT_LT((end.velocity.cwiseProduct(sign) - image.velocity).norm(), 1e-12);
  EXPECT_LT((end.position_m.cwiseProduct(Eigen::Vector3d(1, -1, 1)) - image.position_m).norm(),
            1e-12);
}

// Galilei: in water that moves evenly everything happens as in still water, only carried along.
TEST(Integrator, AConstantCurrentEntersThroughTheRelativeVelocityOnly) {
  RandomStream stream(3, "current");
  const Eigen::Vector3d current(0.3, -0.2, 0.05);
  const simulator::Plant plant = testing::nominal(testing::coupled_vehicle(stream));
  simulator::RotorDrive drive{.commands_rps = simulator::RotorSpeeds(5), .lag_s = 0.2};
  drive.commands_rps << 10.0, -4.0, 8.0, 2.0, 2.0;
  const simulator::State still = testing::random_state(stream);
  simulator::State carried = still;
  carried.velocity.head<3>() += still.attitude.conjugate() * current;

  const simulator::State still_end =
      testing::after(simulator::Dynamics(plant), still, 20.0, 0.01, drive);
  const simulator::State carried_end =
      testing::after(simulator::Dynamics(plant, current), carried, 20.0, 0.01, drive);
  simulator::Vector6 relative = carried_end.velocity;
  relative.head<3>() -= carried_end.attitude.conjugate() * current;
  EXPECT_LT((relative - still_end.velocity).norm(), 1e-6);
  EXPECT_LT((carried_end.position_m - 20.0 * current - still_end.position_m).norm(), 1e-6);
  EXPECT_GT((carried_end.velocity - still_end.velocity).norm(), 0.1);
}

TEST(Integrator, RotorsFollowWithTheirLag) {
  const simulator::Dynamics dynamics(testing::nominal(testing::dagon()));
  simulator::RotorDrive drive{.commands_rps = simulator::RotorSpeeds::Constant(5, 10.0),
                              .lag_s = 0.2};
  const simulator::State lagging = testing::after(dynamics, simulator::State{}, 0.2, 0.01, drive);
  EXPECT_NEAR(lagging.rotors_rps(0), 10.0 * (1.0 - std::exp(-1.0)), 1e-5);
  drive.lag_s = 0.0;
  EXPECT_EQ(simulator::rk4_step(dynamics, simulator::State{}, drive, 0.01).rotors_rps,
            drive.commands_rps);
}

}  // namespace
}  // namespace kelpie::integrator_test
