// SPDX-License-Identifier: Apache-2.0
#include "kelpie/core/scaling.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "kelpie/core/random.hpp"
#include "linear_algebra.hpp"

namespace kelpie::scaling_test {
namespace {

// Correlated samples around a large mean, as raw sensor data are.
Eigen::MatrixXd correlated(std::size_t rows) {
  RandomStream random(1, "scaling");
  Eigen::MatrixXd x(static_cast<Eigen::Index>(rows), 3);
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const double a = random.normal();
    x.row(i) << 1000.0 + a, 5.0 + 0.9 * a + 0.1 * random.normal(), 1e-3 * random.normal();
  }
  return x;
}

Moments moments_of(const Eigen::MatrixXd& x) {
  Moments moments(static_cast<std::size_t>(x.cols()));
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const Eigen::VectorXd row = x.row(i);
    moments.add({row.data(), static_cast<std::size_t>(row.size())});
  }
  return moments;
}

Eigen::MatrixXd as_eigen(const Matrix& matrix) {
  const auto size = static_cast<Eigen::Index>(matrix.rows());
  return Eigen::Map<const Eigen::MatrixXd>(matrix.values().data(), size, size);
}

Eigen::VectorXd as_vector(std::span<const double> x) {
  return Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
}

std::span<const double> span_of(const Eigen::VectorXd& x) {
  return {x.data(), static_cast<std::size_t>(x.size())};
}

TEST(Moments, AgreeWithTwoPasses) {
  const Eigen::MatrixXd x = correlated(500);
  const Moments moments = moments_of(x);
  const Eigen::RowVectorXd mean = x.colwise().mean();
  const Eigen::MatrixXd centred = x.rowwise() - mean;
  const Eigen::MatrixXd covariance = centred.transpose() * centred / 499.0;
  EXPECT_LT((as_vector(moments.mean()) - mean.transpose()).norm(), 1e-9);
  EXPECT_LT((as_eigen(moments.covariance()) - covariance).norm(), 1e-9 * covariance.norm());
}

TEST(InputScaling, DistanceIsMahalanobis) {
  const Eigen::MatrixXd x = correlated(200);
  const Moments moments = moments_of(x);
  const auto scaling = InputScaling::from(moments, ScalingKind::full);
  ASSERT_TRUE(scaling.has_value());
  const Eigen::MatrixXd inverse = testing::inverse(as_eigen(moments.covariance()));
  for (Eigen::Index i = 1; i < 20; ++i) {
    const Eigen::VectorXd a = x.row(0);
    const Eigen::VectorXd b = x.row(i);
    const double expected = (a - b).dot(inverse * (a - b));
    const Eigen::VectorXd apart =
        as_vector(scaling->apply(span_of(a))) - as_vector(scaling->apply(span_of(b)));
    const double got = apart.squaredNorm();
    EXPECT_NEAR(got, expected, 1e-6 * expected);
  }
}

TEST(InputScaling, DiagonalLeavesCorrelatedInputsUnrotated) {
  const Eigen::MatrixXd x = correlated(200);
  const Moments moments = moments_of(x);
  const auto scaling = InputScaling::from(moments, ScalingKind::diagonal);
  ASSERT_TRUE(scaling.has_value());
  const Eigen::VectorXd point = x.row(3);
  const ScaledInput z = scaling->apply(span_of(point));
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(z[k],
                (point[static_cast<Eigen::Index>(k)] - moments.mean()[k]) /
                    std::sqrt(moments.covariance()(k, k)),
                1e-9);
  }
}

TEST(FirstDependent, NamesAConstantColumnAndACombination) {
  Eigen::MatrixXd x = correlated(50);
  EXPECT_FALSE(first_dependent(moments_of(x), ScalingKind::full).has_value());
  Eigen::MatrixXd constant = x;
  constant.col(1).setConstant(0.1);
  EXPECT_EQ(first_dependent(moments_of(constant), ScalingKind::diagonal), 1U);
  EXPECT_EQ(first_dependent(moments_of(constant), ScalingKind::full), 1U);
  EXPECT_FALSE(InputScaling::from(moments_of(constant), ScalingKind::full).has_value());
  Eigen::MatrixXd combined = x;
  combined.col(2) = 2.0 * x.col(0) - x.col(1);
  EXPECT_EQ(first_dependent(moments_of(combined), ScalingKind::full), 2U);
  EXPECT_FALSE(first_dependent(moments_of(combined), ScalingKind::diagonal).has_value());
}

}  // namespace
}  // namespace kelpie::scaling_test
