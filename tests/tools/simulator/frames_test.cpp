// SPDX-License-Identifier: Apache-2.0
#include "simulator/frames.hpp"

#include <gtest/gtest.h>

namespace kelpie::frames_test {
namespace {

TEST(Frames, PlanarPartGoesThereAndBack) {
  const Eigen::Vector3d planar(0.4, 0.1, -0.3);
  const simulator::Vector6 frd = simulator::from_planar_flu(planar);
  EXPECT_EQ(frd, (simulator::Vector6() << 0.4, -0.1, 0, 0, 0, 0.3).finished());
  EXPECT_EQ(simulator::planar_flu(frd), planar);
}

}  // namespace
}  // namespace kelpie::frames_test
