// SPDX-License-Identifier: Apache-2.0
#include "ros/axes.hpp"

#include <gtest/gtest.h>

#include "support.hpp"

namespace kelpie::axes_test {
namespace {

using Axes = std::vector<std::optional<std::size_t>>;

Axes axes_of(const std::string& text) {
  const testing::TemporaryFolder folder;
  testing::write_text(folder / "x.toml", text);
  return ros::acceleration_axes(live::read_configuration(folder / "x.toml", {}));
}

TEST(Axes, FollowFromTheVelocitiesThatTargetsAreDerivativesOf) {
  EXPECT_EQ(axes_of("[log]\ninputs = [\"u\", \"yaw_rate\", \"depth_rate\", \"n\"]\n"
                    "targets = [\"a\", \"b\", \"c\"]\nrate = 10\n"
                    "[log.states]\nu = \"/odom:twist.twist.linear.x\"\n"
                    "yaw_rate = \"/odom:twist.twist.angular.z\"\n"
                    "depth_rate = \"/odom:twist.twist.linear.z\"\n"
                    "[log.commands]\nn = \"/thrusters:data[0]\"\n"
                    "[log.derived]\na = \"d(u)\"\nb = \"d(yaw_rate)\"\nc = \"d(depth_rate)\"\n"),
            (Axes{0, 5, 2}));
}

TEST(Axes, FollowFromTheNamesOfWhatIsMeasured) {
  EXPECT_EQ(axes_of("[log]\ninputs = [\"n\"]\n"
                    "targets = [\"surge_acceleration\", \"yaw_accel\", \"x\", \"y\", \"power\", "
                    "\"udot\"]\nrate = 10\n"
                    "[log.states]\nsurge_acceleration = \"/a:data[0]\"\nyaw_accel = "
                    "\"/a:data[1]\"\nx = \"/imu:linear_acceleration.y\"\n"
                    "y = \"/accel:accel.angular.y\"\npower = \"/a:data[2]\"\nudot = "
                    "\"/a:data[3]\"\n"
                    "[log.commands]\nn = \"/thrusters:data[0]\"\n"),
            (Axes{0, 5, 1, 4, std::nullopt, std::nullopt}));  // surge is the first one's
}

}  // namespace
}  // namespace kelpie::axes_test
