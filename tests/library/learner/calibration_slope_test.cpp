// SPDX-License-Identifier: Apache-2.0
#include "learner/calibration_slope.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "kelpie/core/random.hpp"

namespace kelpie::calibration_slope_test {
namespace {

TEST(CalibrationSlope, BelievesUntilItKnowsBetter) {
  CalibrationSlope slope;
  EXPECT_DOUBLE_EQ(slope.value(), 1.0);
  slope.add(1.0, -1.0);
  EXPECT_GT(slope.value(), 0.5);
}

// Least squares says how much noise that was learned is worth: nothing.
TEST(CalibrationSlope, IsThatOfLeastSquares) {
  RandomStream random(1, "slope");
  for (const double truth : {0.0, 0.4, 1.0}) {
    CalibrationSlope slope;
    for (int i = 0; i < 5000; ++i) {
      const double said = 0.7 * random.normal();
      slope.add(said, truth * said + 0.5 * random.normal());
    }
    EXPECT_NEAR(slope.value(), truth < 0.05 ? CalibrationSlope::kLeast : truth, 0.12) << truth;
  }
}

TEST(CalibrationSlope, IsNeverMoreThanOneAndRisesAgain) {
  CalibrationSlope slope;
  for (int i = 0; i < 2000; ++i) {
    slope.add(1.0, -1.0);
  }
  EXPECT_DOUBLE_EQ(slope.value(), CalibrationSlope::kLeast);
  for (int i = 0; i < 2000; ++i) {
    slope.add(1.0, 2.0);
  }
  EXPECT_DOUBLE_EQ(slope.value(), 1.0);
}

// An outlier counts as three standard deviations.
TEST(CalibrationSlope, AnAbsurdSampleTellsLittle) {
  CalibrationSlope slope;
  for (int i = 0; i < 500; ++i) {
    slope.add(1.0, 1.0);
  }
  slope.add(1.0, -1e300);
  slope.add(1.0, -std::numeric_limits<double>::infinity());
  EXPECT_GT(slope.value(), 0.95);
}

}  // namespace
}  // namespace kelpie::calibration_slope_test
