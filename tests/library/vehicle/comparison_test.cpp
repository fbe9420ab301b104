// SPDX-License-Identifier: Apache-2.0
#include "vehicle/comparison.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <vector>

#include "kelpie/core/random.hpp"
#include "linear_algebra.hpp"

namespace kelpie::comparison_test {
namespace {

struct Rows {
  Eigen::MatrixXd phi;
  Eigen::MatrixXd y;
};

Rows random_rows(RandomStream& random, Eigen::Index count, Eigen::Index terms, Eigen::Index axes) {
  Rows rows{Eigen::MatrixXd(count, terms), Eigen::MatrixXd(count, axes)};
  for (double& value : rows.phi.reshaped()) {
    value = random.normal();
  }
  for (double& value : rows.y.reshaped()) {
    value = random.normal();
  }
  return rows;
}

NormalEquations sums_of(const Rows& rows) {
  NormalEquations sums(static_cast<std::size_t>(rows.phi.cols()),
                       static_cast<std::size_t>(rows.y.cols()));
  for (Eigen::Index i = 0; i < rows.phi.rows(); ++i) {
    const Eigen::VectorXd phi = rows.phi.row(i);
    const Eigen::VectorXd y = rows.y.row(i);
    sums.add({phi.data(), sums.terms()}, {y.data(), sums.targets()});
  }
  return sums;
}

double squares_left(const Eigen::MatrixXd& a, const Eigen::VectorXd& y) {
  return (y - a * testing::least_squares(a, y)).squaredNorm();
}

// Least squares over all rows with the coefficients free, and the sizes in the later rows only.
TEST(Comparison, EvidenceIsThatOfLeastSquaresOverAllRows) {
  RandomStream random(1, "comparison");
  const Rows before = random_rows(random, 60, 4, 1);
  const Rows after = random_rows(random, 25, 4, 1);
  const NormalEquations reference = sums_of(before);
  ReferenceFit fit(4, 1);
  fit.fit(reference);
  const std::vector<double> directions{0.5, 0.0, 1.0, 0.0, 0.0, 2.0, 0.0, -1.0};
  Comparison comparison(4, 1, 2);
  comparison.compare(reference, fit, sums_of(after), directions);

  const Eigen::Map<const Eigen::MatrixXd> along(directions.data(), 4, 2);
  Eigen::MatrixXd all(85, 6);
  all << before.phi, Eigen::MatrixXd::Zero(60, 2), after.phi, after.phi * along;
  Eigen::VectorXd y(85);
  y << before.y, after.y;
  const double none = squares_left(all.leftCols(4), y);
  const double precision = fit.precision()[0];
  const std::vector<std::size_t> both{0, 1};
  const std::vector<std::size_t> first{0};
  EXPECT_NEAR(comparison.of(both).evidence, 0.5 * precision * (none - squares_left(all, y)), 1e-6);
  EXPECT_NEAR(comparison.of(first).evidence,
              0.5 * precision * (none - squares_left(all.leftCols(5), y)), 1e-6);
  const Eigen::VectorXd best = testing::least_squares(all, y);
  EXPECT_NEAR(comparison.of(both).size[0], best(4), 1e-6);
  EXPECT_NEAR(comparison.of(both).size[1], best(5), 1e-6);
  const Eigen::MatrixXd spread = testing::inverse(all.transpose() * all) / precision;
  EXPECT_NEAR(comparison.of(both).error[1], std::sqrt(spread(5, 5)), 1e-6);
}

// Of a straight change a step beyond it leads to the same size.
TEST(Comparison, AStepBeyondAChangeEndsWhereTheWholeOneDoes) {
  RandomStream random(2, "comparison");
  const NormalEquations reference = sums_of(random_rows(random, 80, 3, 2));
  ReferenceFit fit(3, 2);
  fit.fit(reference);
  const std::vector<double> direction{1.0, 0.5, 0.0, -1.0, 0.0, 2.0};
  Comparison comparison(3, 2, 1);
  comparison.compare(reference, fit, sums_of(random_rows(random, 30, 3, 2)), direction);
  const Agreement whole = comparison.of(std::vector<std::size_t>{0});
  std::vector<double> part = direction;
  for (double& value : part) {
    value *= 0.3;
  }
  const Agreement further = comparison.beyond(part, direction);
  EXPECT_NEAR(0.3 + further.size[0], whole.size[0], 1e-9);
  EXPECT_NEAR(further.error[0], whole.error[0], 1e-9);
}

TEST(NormalEquations, AShiftIsThatOfEveryTarget) {
  RandomStream random(3, "sums");
  Rows rows = random_rows(random, 20, 3, 2);
  NormalEquations sums = sums_of(rows);
  const std::vector<double> delta{1.0, -2.0, 0.5, 0.0, 3.0, -1.0};
  sums.shift(delta);
  rows.y += rows.phi * Eigen::Map<const Eigen::MatrixXd>(delta.data(), 3, 2);
  const NormalEquations expected = sums_of(rows);
  EXPECT_LT((sums.moments() - expected.moments()).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((sums.squares() - expected.squares()).cwiseAbs().maxCoeff(), 1e-9);
}

}  // namespace
}  // namespace kelpie::comparison_test
