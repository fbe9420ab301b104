// SPDX-License-Identifier: Apache-2.0
#include "vehicle/parameters.hpp"

#include <gtest/gtest.h>

#include "fixtures.hpp"

namespace kelpie::thrusters_test {
namespace {

TEST(Thrusters, PushesLessInReverse) {
  const vehicle::Thruster surge = testing::dagon().thrusters[vehicle::kSurgeLeft];
  EXPECT_NEAR(vehicle::thrust(surge, 10.0), 2.62, 1e-12);
  EXPECT_NEAR(vehicle::thrust(surge, -10.0), -2.00, 1e-12);
  EXPECT_EQ(vehicle::thrust(surge, 0.0), 0.0);
}

TEST(Thrusters, SpeedForThrustIsTheInverseWithinTheLimits) {
  const vehicle::Thruster sway = testing::dagon().thrusters[vehicle::kSway];
  for (const double speed : {-10.9, -3.0, 0.0, 0.2, 7.0, 10.9}) {
    EXPECT_NEAR(vehicle::speed_for_thrust(sway, vehicle::thrust(sway, speed)), speed, 1e-12);
  }
  EXPECT_EQ(vehicle::speed_for_thrust(sway, 1000.0), 10.9);
  EXPECT_EQ(vehicle::speed_for_thrust(sway, -1000.0), -10.9);
}

// The real log: the right surge thruster turns the bow to port, and so does the sway thruster at
// the stern when it pushes to starboard.
TEST(Thrusters, TurnTheVehicleAsInTheRealLog) {
  const auto thrusters = testing::dagon().thrusters;
  constexpr Eigen::Index kYaw = 5;
  EXPECT_DOUBLE_EQ(vehicle::thrust_axis(thrusters[vehicle::kSurgeLeft])(kYaw), 0.32);
  EXPECT_DOUBLE_EQ(vehicle::thrust_axis(thrusters[vehicle::kSurgeRight])(kYaw), -0.32);
  EXPECT_DOUBLE_EQ(vehicle::thrust_axis(thrusters[vehicle::kSway])(1), 1.0);
  EXPECT_DOUBLE_EQ(vehicle::thrust_axis(thrusters[vehicle::kSway])(kYaw), -0.40);
}

}  // namespace
}  // namespace kelpie::thrusters_test
