// SPDX-License-Identifier: Apache-2.0
#include "simulator/hold.hpp"

#include <gtest/gtest.h>

#include "fixtures.hpp"
#include "simulator/simulator.hpp"

namespace kelpie::hold_test {
namespace {

double pitch(const simulator::State& state) {
  return -std::asin(state.attitude.toRotationMatrix()(2, 0));
}

TEST(Hold, BringsTheVehicleBackToDepthAndLevelAgainstItsBuoyancy) {
  const simulator::VehicleParameters vehicle = testing::dagon();
  simulator::State start;
  start.position_m.z() = 0.3;
  start.attitude = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY());
  simulator::Simulator simulator(vehicle, testing::nominal(vehicle), Eigen::Vector3d::Zero(),
                                 start);
  for (int tick = 0; tick < 300 * simulator::kTicksPerSecond; ++tick) {
    simulator.advance_in_plane(Eigen::Vector3d::Zero());
  }
  EXPECT_NEAR(simulator.state().position_m.z(), 0.0, 1e-3);
  EXPECT_NEAR(pitch(simulator.state()), 0.0, 1e-3);
  // Both vertical thrusters share the 5 N that hold it down.
  const double held =
      2.0 * 0.030 * std::pow(simulator.state().rotors_rps(simulator::kVerticalFront), 2);
  EXPECT_NEAR(held, 5.0, 0.05);
}

TEST(Hold, KeepsDepthAndPitchWhileItIsDrivenHard) {
  const simulator::VehicleParameters vehicle = testing::dagon();
  simulator::Simulator simulator(vehicle, testing::nominal(vehicle), Eigen::Vector3d::Zero(),
                                 simulator::State{});
  double deepest = 0.0;
  double steepest = 0.0;
  for (int tick = 0; tick < 120 * simulator::kTicksPerSecond; ++tick) {
    const double side = tick / 1500 % 2 == 0 ? 1.0 : -1.0;
    simulator.advance_in_plane({12.5 * side, 12.5, -10.9 * side});
    deepest = std::max(deepest, std::abs(simulator.state().position_m.z()));
    steepest = std::max(steepest, std::abs(pitch(simulator.state())));
  }
  EXPECT_LT(deepest, 0.1);
  EXPECT_LT(steepest, 0.1);
}

// 50 N of buoyancy are more than the thrusters can hold. Once it is gone, the integral must not
// have grown beyond them, or it would drive the vehicle far down.
TEST(Hold, IntegralDoesNotWindUp) {
  const simulator::VehicleParameters vehicle = testing::dagon();
  simulator::VehicleParameters buoyant = vehicle;
  buoyant.net_buoyancy_n = 50.0;
  simulator::Simulator simulator(vehicle, testing::nominal(buoyant), Eigen::Vector3d::Zero(),
                                 simulator::State{});
  for (int tick = 0; tick < 60 * simulator::kTicksPerSecond; ++tick) {
    simulator.advance_in_plane(Eigen::Vector3d::Zero());
  }
  simulator.set_plant(testing::nominal(vehicle));
  double deepest = 0.0;
  for (int tick = 0; tick < 1000 * simulator::kTicksPerSecond; ++tick) {
    simulator.advance_in_plane(Eigen::Vector3d::Zero());
    deepest = std::max(deepest, simulator.state().position_m.z());
  }
  EXPECT_LT(deepest, 3.0);
  EXPECT_NEAR(simulator.state().position_m.z(), 0.0, 0.05);
}

}  // namespace
}  // namespace kelpie::hold_test
