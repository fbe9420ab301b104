// SPDX-License-Identifier: Apache-2.0
#include "lab/fossen_terms.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace kelpie::fossen_terms_test {
namespace {

TEST(lab::FossenTerms, ArePlanarMotionsTermsInTheirOrder) {
  const lab::FossenTerms terms(3, 2);
  const lab::FossenTerms::Values values = terms(std::vector{2.0, -3.0, 0.5, 4.0, -5.0});
  const std::vector<double> expected{2.0,  -3.0, 0.5,  4.0,   -9.0, 0.25,  // ν, ν|ν|
                                     -6.0, 1.0,  -1.5, 0.25,               // uv, ur, vr, r²
                                     16.0, 0.0,  -0.0, -25.0, 1.0};        // thrusters, constant
  EXPECT_EQ(std::vector<double>(values.begin(), values.end()), expected);
  EXPECT_EQ(terms.size(), expected.size());
}

TEST(lab::FossenTerms, FitTheirStackForEveryNumberOfInputsAllowed) {
  for (std::size_t velocities = 1; velocities <= lab::FossenTerms::kMostVelocities; ++velocities) {
    const lab::FossenTerms terms(velocities, 64 - velocities);
    EXPECT_LE(terms.size(), static_cast<std::size_t>(lab::FossenTerms::kMostTerms));
    EXPECT_EQ(static_cast<std::size_t>(terms(std::vector(64, 1.0)).size()), terms.size());
  }
}

}  // namespace
}  // namespace kelpie::fossen_terms_test
