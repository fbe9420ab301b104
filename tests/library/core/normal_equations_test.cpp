// SPDX-License-Identifier: Apache-2.0
#include "core/normal_equations.hpp"

#include <gtest/gtest.h>

#include <array>

namespace kelpie::normal_equations_test {
namespace {

// 0 · ∞ is no number.
TEST(NormalEquations, AreEmptyAfterClearWhateverTheyHeld) {
  NormalEquations sums(1, 1);
  sums.add(std::array{1e200}, std::array{1.0});
  sums.clear();
  EXPECT_EQ(sums.rows(), 0.0);
  sums.add(std::array{2.0}, std::array{3.0});
  EXPECT_EQ(sums.gram()(0, 0), 4.0);
}

}  // namespace
}  // namespace kelpie::normal_equations_test
