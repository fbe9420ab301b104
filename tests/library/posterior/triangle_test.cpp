// SPDX-License-Identifier: Apache-2.0
#include "posterior/triangle.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "kelpie/core/random.hpp"
#include "saved_state.hpp"

namespace kelpie::triangle_test {
namespace {

constexpr std::size_t kSize = 37;  // no multiple of a vector of the machine

Eigen::VectorXd random_vector(RandomStream& random, std::size_t size = kSize) {
  Eigen::VectorXd x(static_cast<Eigen::Index>(size));
  for (double& one : x) {
    one = random.normal();
  }
  return x;
}

std::span<double> as_span(Eigen::VectorXd& x) {
  return {x.data(), static_cast<std::size_t>(x.size())};
}

// Σ w x xᵀ, by the class and by Eigen.
struct Both {
  Triangle triangle{kSize};
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(kSize, kSize);

  explicit Both(std::size_t rank = 3 * kSize) {
    RandomStream random(1, "triangle");
    triangle.resize(kSize);
    for (std::size_t i = 0; i < rank; ++i) {
      Eigen::VectorXd x = random_vector(random);
      const double weight = random.uniform(0.1, 2.0);
      triangle.add_square(weight, as_span(x));
      matrix += weight * x * x.transpose();
    }
  }

  bool factorise() {
    bool is_definite = true;
    for (std::size_t i = 0; i < kSize; ++i) {
      is_definite = triangle.factorise_row(i) && is_definite;
    }
    return is_definite;
  }
};

TEST(Triangle, SumsAndMultipliesAsEigen) {
  const Both both;
  RandomStream random(2, "x");
  Eigen::VectorXd x = random_vector(random);
  Eigen::VectorXd y(kSize);
  both.triangle.multiply(as_span(x), as_span(y));
  EXPECT_LT((y - both.matrix * x).norm(), 1e-12 * y.norm());
  EXPECT_DOUBLE_EQ(both.triangle.diagonal(5), both.triangle.row(5)[5]);
}

TEST(Triangle, FactorisesRowByRowAsEigen) {
  Both both;
  ASSERT_TRUE(both.factorise());
  const Eigen::MatrixXd expected = both.matrix.llt().matrixL();
  for (std::size_t i = 0; i < kSize; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      EXPECT_NEAR(both.triangle.row(i)[j],
                  expected(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)), 1e-11);
    }
  }
}

// The leading block of a factor is the factor of the leading block.
TEST(Triangle, SolvesWithTheWholeAndWithALeadingBlock) {
  Both both;
  ASSERT_TRUE(both.factorise());
  RandomStream random(3, "right side");
  for (const std::size_t size : {kSize, kSize / 2, std::size_t{1}}) {
    const auto n = static_cast<Eigen::Index>(size);
    const Eigen::VectorXd right = random_vector(random, size);
    Eigen::VectorXd x = right;
    both.triangle.solve_lower(as_span(x));
    both.triangle.solve_upper(as_span(x));
    EXPECT_LT((both.matrix.topLeftCorner(n, n) * x - right).norm(), 1e-10 * right.norm()) << size;
  }
}

TEST(Triangle, ReportsAMatrixThatIsNotDefinite) {
  EXPECT_FALSE(Both(kSize / 2).factorise());
}

TEST(Triangle, NewRowsAreZeroAndTheStateIsSaved) {
  Both both;
  Triangle larger(kSize + 2);
  larger.resize(2);
  larger.row(1)[1] = 3.0;
  larger.resize(4);
  EXPECT_EQ(larger.row(3)[0], 0.0);
  EXPECT_EQ(larger.row(1)[1], 3.0);
  Triangle loaded(kSize);
  testing::load(loaded, testing::saved(both.triangle));
  EXPECT_EQ(testing::saved(loaded), testing::saved(both.triangle));
}

}  // namespace
}  // namespace kelpie::triangle_test
