// SPDX-License-Identifier: Apache-2.0
#include "alignment/fold_evidence.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace kelpie::fold_evidence_test {
namespace {

TEST(FoldEvidence, TheMiddleFoldsLeaveOutTheOneThatTellsOtherwise) {
  Eigen::ArrayXXd gains = Eigen::ArrayXXd::Constant(10, 2, 0.1);
  gains.row(3) += 0.02;
  gains.row(9) = -1.0;  // a command moves in no other fold
  EXPECT_FALSE(FoldEvidence(gains).is_clear());
  EXPECT_TRUE(FoldEvidence(gains, Folds::middle).is_clear());
  gains.row(8) = -1.0;
  EXPECT_FALSE(FoldEvidence(gains, Folds::middle).is_clear());
}

// By hand: Yuen's standard error is the winsorised deviation over (1 - 2 g/n) √n.
TEST(FoldEvidence, MeansAndStandardErrors) {
  Eigen::ArrayXXd gains(5, 1);
  gains << 4.0, 1.0, 3.0, 2.0, 90.0;
  const FoldEvidence all(gains);
  EXPECT_DOUBLE_EQ(all.mean, 20.0);
  EXPECT_NEAR(all.error, 17.507141, 1e-6);
  const FoldEvidence middle(gains, Folds::middle);
  EXPECT_DOUBLE_EQ(middle.mean, 3.0);
  EXPECT_NEAR(middle.error, 1.0 / (0.6 * std::sqrt(5.0)), 1e-12);
}

}  // namespace
}  // namespace kelpie::fold_evidence_test
