// SPDX-License-Identifier: Apache-2.0
#include "learner/triangular_fit.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "kelpie/core/random.hpp"
#include "saved_state.hpp"

namespace kelpie::triangular_fit_test {
namespace {

struct Rows {
  Eigen::MatrixXd phi;
  Eigen::VectorXd y;
};

std::vector<double> numbers(std::span<const double> values) {
  return {values.begin(), values.end()};
}

// The values of all terms in one row.
std::vector<double> phi_of(const Rows& rows, Eigen::Index i) {
  const Eigen::VectorXd phi = rows.phi.row(i).transpose();
  return {phi.begin(), phi.end()};
}

// Terms of very different size.
Rows rows(Eigen::Index count) {
  RandomStream random(4, "rows");
  Rows rows{Eigen::MatrixXd(count, 3), Eigen::VectorXd(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    rows.phi.row(i) << 1e4 * random.normal(), 1e-3 * random.normal(), 1.0;
    rows.y[i] = 2e-4 * rows.phi(i, 0) - 500.0 * rows.phi(i, 1) + 3.0 + 0.1 * random.normal();
  }
  return rows;
}

TEST(TriangularFit, IsLeastSquaresButForItsPrior) {
  const Rows all = rows(400);
  TriangularFit fit(3, 1e-9);
  for (Eigen::Index i = 0; i < all.y.size(); ++i) {
    fit.add(phi_of(all, i), all.y[i]);
  }
  const Eigen::LDLT<Eigen::MatrixXd> normal(all.phi.transpose() * all.phi);
  const Eigen::VectorXd theta = normal.solve(all.phi.transpose() * all.y);
  const Eigen::MatrixXd covariance = normal.solve(Eigen::MatrixXd::Identity(3, 3));
  for (Eigen::Index k = 0; k < 3; ++k) {
    const auto term = static_cast<std::size_t>(k);
    EXPECT_NEAR(fit.theta()[term] / theta[k], 1.0, 1e-7);
    EXPECT_NEAR(fit.variance(term) / covariance(k, k), 1.0, 1e-7);
  }
  EXPECT_EQ(fit.rows(), 400);
}

TEST(TriangularFit, ForgetsByKeepAndStaysWhereItIs) {
  const Rows all = rows(300);
  const std::vector<double> keep(3, std::sqrt(0.95));
  TriangularFit fit(3, 1e-9);
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(3, 3);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(3);
  for (Eigen::Index i = 0; i < all.y.size(); ++i) {
    const std::vector<double> before = numbers(fit.theta());
    fit.forget(keep);
    ASSERT_EQ(numbers(fit.theta()), before);
    fit.add(phi_of(all, i), all.y[i]);
    information = 0.95 * information + all.phi.row(i).transpose() * all.phi.row(i);
    right = 0.95 * right + all.phi.row(i).transpose() * all.y[i];
  }
  const Eigen::VectorXd theta = information.ldlt().solve(right);
  for (Eigen::Index k = 0; k < 3; ++k) {
    EXPECT_NEAR(fit.theta()[static_cast<std::size_t>(k)] / theta[k], 1.0, 1e-6);
  }
}

TEST(TriangularFit, CountsRowsSoFarAsFew) {
  const Rows all = rows(300);
  TriangularFit fit(3, 1e-9);
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(300);
  weights.head(200).setConstant(50.0 / 200.0);
  for (Eigen::Index i = 0; i < all.y.size(); ++i) {
    if (i == 200) {
      const std::vector<double> before = numbers(fit.theta());
      fit.limit_rows(50);
      fit.limit_rows(80);  // they are fewer already
      ASSERT_EQ(numbers(fit.theta()), before);
    }
    fit.add(phi_of(all, i), all.y[i]);
  }
  EXPECT_EQ(fit.rows(), 150);
  const Eigen::VectorXd theta = (all.phi.transpose() * weights.asDiagonal() * all.phi)
                                    .ldlt()
                                    .solve(all.phi.transpose() * weights.asDiagonal() * all.y);
  for (Eigen::Index k = 0; k < 3; ++k) {
    EXPECT_NEAR(fit.theta()[static_cast<std::size_t>(k)] / theta[k], 1.0, 1e-6);
  }
}

TEST(TriangularFit, HoldsATermAtZeroAsManyRowsWould) {
  const Rows all = rows(300);
  TriangularFit fit(3, 1e-9);
  for (Eigen::Index i = 0; i < all.y.size(); ++i) {
    fit.add(phi_of(all, i), all.y[i]);
  }
  fit.hold(1, 600.0);
  Eigen::MatrixXd information = all.phi.transpose() * all.phi;
  information(1, 1) *= 3.0;
  const Eigen::VectorXd theta = information.ldlt().solve(all.phi.transpose() * all.y);
  for (Eigen::Index k = 0; k < 3; ++k) {
    EXPECT_NEAR(fit.theta()[static_cast<std::size_t>(k)] / theta[k], 1.0, 1e-6);
  }
}

TEST(TriangularFit, KnowsNothingOfATermThatNeverMoved) {
  TriangularFit fit(2, 0.1);
  for (int i = 0; i < 20; ++i) {
    fit.add(std::array{0.0, 1.0}, 5.0);
  }
  EXPECT_EQ(fit.theta()[0], 0.0);
  EXPECT_TRUE(std::isinf(fit.variance(0)));
  EXPECT_NEAR(fit.theta()[1], 5.0, 0.05);
}

TEST(TriangularFit, ClearedItIsAsNew) {
  const Rows all = rows(50);
  TriangularFit fit(3, 0.1);
  TriangularFit fresh(3, 0.1);
  fit.add(std::array{1.0, 2.0, 3.0}, 4.0);
  fit.clear();
  for (Eigen::Index i = 0; i < all.y.size(); ++i) {
    fit.add(phi_of(all, i), all.y[i]);
    fresh.add(phi_of(all, i), all.y[i]);
  }
  EXPECT_EQ(numbers(fit.theta()), numbers(fresh.theta()));
}

// A checkpoint has no place for terms that never moved, and a fit goes on from it bit by bit.
TEST(TriangularFit, SavedWithoutTermsThatNeverMoved) {
  const Rows all = rows(50);
  constexpr std::size_t kTerms = 200;
  TriangularFit fit(kTerms, 0.1);
  std::vector<double> phi(kTerms);
  const auto add = [&](TriangularFit& to, Eigen::Index i) {
    std::ranges::copy(phi_of(all, i), phi.begin() + 100);
    to.add(phi, all.y[i]);
  };
  for (Eigen::Index i = 0; i < 25; ++i) {
    add(fit, i);
  }
  const std::string bytes = testing::saved(fit);
  EXPECT_LT(bytes.size(), 8 * (kTerms * 4 + 3 * (kTerms + 1) + 1));
  TriangularFit loaded(kTerms, 0.1);
  loaded.add(std::vector<double>(kTerms, 1.0), 1.0);
  testing::load(loaded, bytes);
  for (Eigen::Index i = 25; i < 50; ++i) {
    add(fit, i);
    add(loaded, i);
  }
  EXPECT_EQ(numbers(loaded.theta()), numbers(fit.theta()));
  EXPECT_EQ(loaded.variance(101), fit.variance(101));
}

// Targets that share their rows are fitted as if each were alone, whatever is done to the rows.
TEST(TriangularFit, SeveralTargetsAreAsManyFits) {
  const Rows all = rows(300);
  TriangularFit both(3, 0.1, 2);
  TriangularFit first(3, 0.1);
  TriangularFit second(3, 0.1);
  const auto other = [](std::span<const double> phi) { return 1e-4 * phi[0] - 2.0 * phi[2]; };
  const std::array<double, 3> keep{0.9, 0.8, 0.7};
  for (Eigen::Index i = 0; i < all.y.size(); ++i) {
    const std::vector<double> phi = phi_of(all, i);
    both.add(phi, std::array{all.y[i], other(phi)});
    first.add(phi, all.y[i]);
    second.add(phi, other(phi));
    if (i == 100 || i == 200) {
      for (TriangularFit* const fit : {&both, &first, &second}) {
        fit->forget(keep);
        fit->limit_rows(50);
        fit->hold(1, 20.0);
      }
    }
  }
  ASSERT_EQ(both.targets(), 2U);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(both.theta(0)[k], first.theta()[k], 1e-9 * std::abs(first.theta()[k]));
    EXPECT_NEAR(both.theta(1)[k], second.theta()[k], 1e-9 * std::abs(second.theta()[k]) + 1e-12);
    EXPECT_NEAR(both.variance(k), first.variance(k), 1e-9 * first.variance(k));
  }
}

}  // namespace
}  // namespace kelpie::triangular_fit_test
