// SPDX-License-Identifier: Apache-2.0
#include "learner/error_correlation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kelpie/core/random.hpp"

namespace kelpie::error_correlation_test {
namespace {

// τ of 20,000 errors e ← a e + noise, each shown `copies` times by linear interpolation.
double rows_per_sample(double a, int copies) {
  RandomStream random(1, "errors");
  ErrorCorrelation correlation;
  double before = 0.0;
  for (int i = 0; i < 20'000; ++i) {
    const double error = a * before + random.normal();
    for (int k = 1; k <= copies; ++k) {
      correlation.add(before + (error - before) * k / copies);
    }
    before = error;
  }
  return correlation.rows_per_sample();
}

TEST(ErrorCorrelation, CountsNeighboursThatSayTheSame) {
  EXPECT_NEAR(rows_per_sample(0.0, 1), 1.0, 0.2);
  EXPECT_NEAR(rows_per_sample(0.5, 1), 3.0, 0.6);
  EXPECT_NEAR(rows_per_sample(0.9, 1), 19.0, 5.0);
}

// A second is a second: at ten times the rate ten rows tell what one did.
TEST(ErrorCorrelation, GoesWithTheRate) {
  const double slow = rows_per_sample(0.9, 1);
  EXPECT_NEAR(rows_per_sample(0.9, 10) / (10.0 * slow), 1.0, 0.3);
}

}  // namespace
}  // namespace kelpie::error_correlation_test
