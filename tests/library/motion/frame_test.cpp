// SPDX-License-Identifier: Apache-2.0
#include "kelpie/motion/frame.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::frame_test {
namespace {

const Triple kVector{1.0, 2.0, 3.0};

Triple turned(const Eigen::Matrix3d& rotation) {
  const Eigen::Vector3d vector = rotation * Eigen::Vector3d(1.0, 2.0, 3.0);
  return {vector(0), vector(1), vector(2)};
}

void expect_near(const Triple& a, const Triple& b) {
  for (std::size_t c = 0; c < a.size(); ++c) {
    EXPECT_NEAR(a[c], b[c], 1e-12);
  }
}

TEST(Frame, BetweenFluAndFrdLiesAHalfTurnAboutX) {
  const Eigen::Matrix3d turn(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));
  expect_near(converted(kVector, Frame::flu, Frame::frd), turned(turn));
  expect_near(converted(kVector, Frame::frd, Frame::flu), turned(turn));
}

TEST(Frame, BetweenEnuAndNedLiesAHalfTurnAboutTheirDiagonal) {
  const Eigen::Matrix3d turn(Eigen::AngleAxisd(M_PI, Eigen::Vector3d(1, 1, 0).normalized()));
  expect_near(converted(kVector, Frame::enu, Frame::ned), turned(turn));
  expect_near(converted(converted(kVector, Frame::enu, Frame::ned), Frame::ned, Frame::enu),
              kVector);
}

TEST(Frame, NamesAreKnownAndKindsDoNotMix) {
  EXPECT_EQ(frame_from("NED"), Frame::ned);
  EXPECT_NE(testing::message_of<InputError>([] { frame_from("FLD"); }).find("did you mean 'FLU'"),
            std::string::npos);
  EXPECT_NE(testing::message_of<InputError>([] {
              converted({}, Frame::flu, Frame::ned);
            }).find("attitude"),
            std::string::npos);
}

TEST(Frame, OnASpinningBodyAnArmMovesAndTheOriginStands) {
  const Eigen::Vector3d rates(0.1, -0.2, 0.5);
  const Eigen::Vector3d arm(0.3, -0.1, 0.7);
  const Eigen::Vector3d sensed = rates.cross(arm);  // of a point of a body that only turns
  expect_near(
      without_lever_arm({sensed(0), sensed(1), sensed(2)}, {0.1, -0.2, 0.5}, {0.3, -0.1, 0.7}),
      {0.0, 0.0, 0.0});
}

}  // namespace
}  // namespace kelpie::frame_test
