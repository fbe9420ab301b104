// SPDX-License-Identifier: Apache-2.0
#include "vehicle/frames.hpp"

#include <gtest/gtest.h>

namespace kelpie::frames_test {
namespace {

TEST(Frames, PlanarPartGoesThereAndBack) {
  const Eigen::Vector3d planar(0.4, 0.1, -0.3);
  const vehicle::Vector6 frd = vehicle::from_planar_flu(planar);
  EXPECT_EQ(frd, (vehicle::Vector6() << 0.4, -0.1, 0, 0, 0, 0.3).finished());
  EXPECT_EQ(vehicle::planar_flu(frd), planar);
}

}  // namespace
}  // namespace kelpie::frames_test
