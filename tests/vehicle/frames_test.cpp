// SPDX-License-Identifier: Apache-2.0
#include "kelpie/vehicle/frames.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace kelpie::frames_test {
namespace {

TEST(Frames, FlipIsAHalfTurnAboutForwards) {
  const Vector6 frd = (Vector6() << 1, 2, 3, 4, 5, 6).finished();
  const Vector6 flu = (Vector6() << 1, -2, -3, 4, -5, -6).finished();
  EXPECT_EQ(flip_flu_frd(frd), flu);
  EXPECT_EQ(flip_flu_frd(flu), frd);
  const Eigen::AngleAxisd half_turn(std::numbers::pi, Eigen::Vector3d::UnitX());
  EXPECT_TRUE((half_turn * frd.head<3>()).isApprox(flu.head<3>(), 1e-15));
}

TEST(Frames, PlanarPartGoesThereAndBack) {
  const Eigen::Vector3d planar(0.4, 0.1, -0.3);
  const Vector6 frd = from_planar_flu(planar);
  EXPECT_EQ(frd, (Vector6() << 0.4, -0.1, 0, 0, 0, 0.3).finished());
  EXPECT_EQ(planar_flu(frd), planar);
}

}  // namespace
}  // namespace kelpie::frames_test
