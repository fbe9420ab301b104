// SPDX-License-Identifier: Apache-2.0
#include "vehicle/standstill.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace kelpie::standstill_test {
namespace {

class StandstillTest : public ::testing::Test {
 protected:
  // Ten rows a second; an input that does not move repeats its last reading.
  void show(int rows, bool u, bool v, bool r) {
    for (int i = 0; i < rows; ++i) {
      t_ += 0.1;
      x_[0] = u ? std::sin(t_) : x_[0];
      x_[1] = v ? std::cos(t_) : x_[1];
      x_[2] = r ? std::sin(0.7 * t_) : x_[2];
      standstill_.update(x_, t_);
    }
  }

  Standstill standstill_{{0, 1, 2}};
  std::array<double, 3> x_{};
  double t_ = 0.0;
};

TEST_F(StandstillTest, AnInputFreezesWhileOthersMove) {
  show(100, true, true, true);
  show(49, true, false, true);
  EXPECT_FALSE(standstill_.any());
  show(2, true, false, true);
  EXPECT_TRUE(standstill_.frozen(1));
  EXPECT_NEAR(standstill_.since(1), 10.0, 0.15);
  show(1, true, true, true);
  EXPECT_FALSE(standstill_.any());
}

TEST_F(StandstillTest, AnInputThatHasYetToMoveAfterARestIsNotFrozen) {
  show(100, false, false, false);
  show(40, true, false, false);  // straight ahead for 4 s
  EXPECT_FALSE(standstill_.any());
}

TEST_F(StandstillTest, ARestIsNoUsualHold) {
  show(600, false, false, false);
  show(100, true, true, true);
  show(60, true, true, false);
  EXPECT_TRUE(standstill_.frozen(2));
}

}  // namespace
}  // namespace kelpie::standstill_test
