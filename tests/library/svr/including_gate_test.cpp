// SPDX-License-Identifier: Apache-2.0
#include "svr/including_gate.hpp"

#include <gtest/gtest.h>

#include <array>

namespace kelpie::including_gate_test {
namespace {

OnlineSvrSettings settings() {
  OnlineSvrSettings values;
  values.epsilon = 0.1;
  values.xi = 0.9;
  values.a = 0.95;
  values.b = 0.01;
  return values;
}

TEST(IncludingGate, NamesTheRuleThatTurnsASampleAway) {
  const IncludingGate gate(settings());
  const std::array similarity{0.2, 0.93};
  const std::array targets{5.0, 1.0};
  // eq. (9): close (κ > ξ) and inside the tube.
  EXPECT_EQ(gate.check(similarity, targets, 1.05, 1.0), Verdict::explained);
  // Close, but outside of the tube: something to learn. On the tube's edge as well (strictly <).
  EXPECT_EQ(gate.check(similarity, targets, 1.2, 1.0), Verdict::accepted);
  EXPECT_EQ(gate.check(similarity, targets, 0.125, 0.0), Verdict::accepted);
  // Inside the tube, but far from everybody: new ground.
  EXPECT_EQ(gate.check(std::array{0.2, 0.9}, targets, 1.0, 1.0), Verdict::accepted);
  // eq. (10): closer still (κ > a) and the same target, however wrong the prediction.
  EXPECT_EQ(gate.check(std::array{0.2, 0.96}, targets, 3.0, 1.005), Verdict::duplicate);
  EXPECT_EQ(gate.check(std::array{0.2, 0.96}, targets, 3.0, 1.02), Verdict::accepted);
  EXPECT_EQ(gate.check(similarity, targets, 3.0, 1.005), Verdict::accepted);
  // The same target belongs to a sample that isn't the close one.
  EXPECT_EQ(gate.check(std::array{0.96, 0.2}, targets, 3.0, 1.0), Verdict::accepted);
  EXPECT_EQ(gate.check({}, {}, 0.0, 0.0), Verdict::accepted);
}

}  // namespace
}  // namespace kelpie::including_gate_test
