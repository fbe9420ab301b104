// SPDX-License-Identifier: Apache-2.0
#include "vehicle/frames.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace kelpie::frames_test {
namespace {

TEST(Frames, FlipIsAHalfTurnAboutForwards) {
  const vehicle::Vector6 frd = (vehicle::Vector6() << 1, 2, 3, 4, 5, 6).finished();
  const vehicle::Vector6 flu = (vehicle::Vector6() << 1, -2, -3, 4, -5, -6).finished();
  EXPECT_EQ(vehicle::flip_flu_frd(frd), flu);
  EXPECT_EQ(vehicle::flip_flu_frd(flu), frd);
  const Eigen::AngleAxisd half_turn(std::numbers::pi, Eigen::Vector3d::UnitX());
  EXPECT_TRUE((half_turn * frd.head<3>()).isApprox(flu.head<3>(), 1e-15));
}

TEST(Frames, PlanarPartGoesThereAndBack) {
  const Eigen::Vector3d planar(0.4, 0.1, -0.3);
  const vehicle::Vector6 frd = vehicle::from_planar_flu(planar);
  EXPECT_EQ(frd, (vehicle::Vector6() << 0.4, -0.1, 0, 0, 0, 0.3).finished());
  EXPECT_EQ(vehicle::planar_flu(frd), planar);
}

}  // namespace
}  // namespace kelpie::frames_test
