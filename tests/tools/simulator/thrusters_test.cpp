// SPDX-License-Identifier: Apache-2.0
#include "simulator/parameters.hpp"

#include <gtest/gtest.h>

#include "fixtures.hpp"

namespace kelpie::thrusters_test {
namespace {

TEST(Thrusters, PushesLessInReverse) {
  const simulator::Thruster surge = testing::dagon().thrusters[simulator::kSurgeLeft];
  EXPECT_NEAR(simulator::thrust(surge, 10.0), 2.62, 1e-12);
  EXPECT_NEAR(simulator::thrust(surge, -10.0), -2.00, 1e-12);
  EXPECT_EQ(simulator::thrust(surge, 0.0), 0.0);
}

TEST(Thrusters, SpeedForThrustIsTheInverseWithinTheLimits) {
  const simulator::Thruster sway = testing::dagon().thrusters[simulator::kSway];
  for (const double speed : {-10.9, -3.0, 0.0, 0.2, 7.0, 10.9}) {
    EXPECT_NEAR(simulator::speed_for_thrust(sway, simulator::thrust(sway, speed)), speed, 1e-12);
  }
  EXPECT_EQ(simulator::speed_for_thrust(sway, 1000.0), 10.9);
  EXPECT_EQ(simulator::speed_for_thrust(sway, -1000.0), -10.9);
}

// The real log: the right surge thruster turns the bow to port, and so does the sway thruster at
// the stern when it pushes to starboard.
TEST(Thrusters, TurnTheVehicleAsInTheRealLog) {
  const auto thrusters = testing::dagon().thrusters;
  constexpr Eigen::Index kYaw = 5;
  EXPECT_DOUBLE_EQ(simulator::thrust_axis(thrusters[simulator::kSurgeLeft])(kYaw), 0.32);
  EXPECT_DOUBLE_EQ(simulator::thrust_axis(thrusters[simulator::kSurgeRight])(kYaw), -0.32);
  EXPECT_DOUBLE_EQ(simulator::thrust_axis(thrusters[simulator::kSway])(1), 1.0);
  EXPECT_DOUBLE_EQ(simulator::thrust_axis(thrusters[simulator::kSway])(kYaw), -0.40);
}

}  // namespace
}  // namespace kelpie::thrusters_test
