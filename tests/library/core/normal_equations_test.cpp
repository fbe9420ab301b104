// SPDX-License-Identifier: Apache-2.0
#include "core/normal_equations.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace kelpie::normal_equations_test {
namespace {

// Others may read meanwhile: a saved object keeps all its bits, those of rounding too.
TEST(NormalEquations, SavingChangesNothing) {
  Eigen::MatrixXd design(7, 3);
  Eigen::VectorXd weights(7);
  for (Eigen::Index i = 0; i < design.size(); ++i) {
    design.data()[i] = std::sin(1.0 + 0.7 * static_cast<double>(i));
    weights(i % 7) = 0.1 + 0.03 * static_cast<double>(i % 7);
  }
  NormalEquations sums = NormalEquations::of_weighted(design, design.leftCols(1), weights);
  const Eigen::MatrixXd before = sums.gram();
  ASSERT_NE(before, before.transpose());
  Archive archive;
  sums.visit(archive);
  EXPECT_EQ(Eigen::MatrixXd(sums.gram()), before);

  NormalEquations loaded(3, 1);
  Archive from(archive.bytes());
  loaded.visit(from);
  from.finish();
  EXPECT_EQ(Eigen::MatrixXd(loaded.gram()), Eigen::MatrixXd(loaded.gram().transpose()));
  EXPECT_NEAR((loaded.gram() - before).norm(), 0.0, 1e-14);
}

}  // namespace
}  // namespace kelpie::normal_equations_test
