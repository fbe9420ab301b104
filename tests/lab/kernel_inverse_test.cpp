// SPDX-License-Identifier: Apache-2.0
#include "lab/kernel_inverse.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "kelpie/core/random.hpp"
#include "linear_algebra.hpp"
#include "svr/sample_store.hpp"
#include "svr/squared_exponential.hpp"

namespace kelpie::kernel_inverse_test {
namespace {

constexpr double kRidge = 1e-6;
constexpr std::size_t kPlaces = 40;

// Kernel matrix and inverse of samples that come and go together.
struct Dictionary {
  SquaredExponential kernel{0.5};
  SampleStore samples{2, kPlaces};
  KernelMatrix matrix{kPlaces};
  lab::KernelInverse inverse{kPlaces, kRidge};
  std::vector<double> row = std::vector<double>(kPlaces);

  std::span<const double> similarity(const std::vector<double>& z) {
    kernel.row(z, samples, row);
    return {row.data(), samples.size()};
  }
  void add(const std::vector<double>& z) {
    const std::span<const double> k = similarity(z);
    inverse.add(k, 1.0);
    matrix.add(k, 1.0);
    samples.push_back(z);
  }
  void remove(std::size_t i) {
    inverse.remove(i);
    matrix.remove(i);
    samples.remove(i);
  }
  Eigen::MatrixXd regularised() const {
    const auto n = static_cast<Eigen::Index>(matrix.size());
    Eigen::MatrixXd k(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) {
        k(i, j) = matrix(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
      }
    }
    return k + kRidge * Eigen::MatrixXd::Identity(n, n);
  }
  double largest_error() const {
    const Eigen::MatrixXd exact = testing::inverse(regularised());
    double largest = 0.0;
    for (Eigen::Index i = 0; i < exact.rows(); ++i) {
      for (Eigen::Index j = 0; j < exact.cols(); ++j) {
        const double kept = inverse(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
        largest = std::max(largest, std::abs(kept - exact(i, j)));
      }
    }
    return largest / exact.cwiseAbs().maxCoeff();
  }
};

std::vector<double> somewhere(RandomStream& random) {
  return {random.uniform(-4.0, 4.0), random.uniform(-4.0, 4.0)};
}

TEST(KernelInverse, StaysTheInverseOverThousandsOfChanges) {
  RandomStream random(1, "inverse");
  Dictionary dictionary;
  for (int change = 0; change < 5000; ++change) {
    const std::size_t n = dictionary.samples.size();
    if (n == kPlaces || (n > 0 && random.below(2) == 0)) {
      dictionary.remove(random.below(n));
    } else {
      dictionary.add(somewhere(random));
      dictionary.inverse.keep_exact(dictionary.matrix);
    }
    if (change % 100 == 0 && dictionary.samples.size() > 0) {
      ASSERT_LT(dictionary.largest_error(), 1e-6) << change;
    }
  }
}

TEST(KernelInverse, IndependenceIsThatOfLeavingTheSampleOut) {
  RandomStream random(2, "leave one out");
  Dictionary dictionary;
  for (std::size_t i = 0; i < 25; ++i) {
    dictionary.add(somewhere(random));
  }
  for (std::size_t i = 0; i < 25; ++i) {
    std::vector<double> left_out(2);
    dictionary.samples.get(i, left_out);
    Dictionary others = dictionary;
    others.remove(i);
    const std::span<const double> row = others.similarity(left_out);
    const Eigen::Map<const Eigen::VectorXd> k(row.data(), 24);
    const double by_definition = 1.0 - k.dot(testing::least_squares(others.regularised(), k));
    EXPECT_NEAR(dictionary.inverse.independence(i), by_definition, 1e-8);
    EXPECT_NEAR(others.inverse.independence(row, 1.0), by_definition, 1e-8);
  }
}

TEST(KernelInverse, OfADuplicateSaysItIsNoNews) {
  Dictionary dictionary;
  dictionary.add({0.3, 0.4});
  EXPECT_NEAR(dictionary.inverse.independence(dictionary.similarity({0.3, 0.4}), 1.0), 0.0,
              2 * kRidge);
  for (int copy = 0; copy < 30; ++copy) {
    dictionary.add({0.3, 0.4});
  }
  EXPECT_LT(dictionary.largest_error(), 1e-2);  // nothing but the ridge tells the copies apart
  for (int copy = 0; copy < 30; ++copy) {
    dictionary.remove(0);
  }
  EXPECT_NEAR(dictionary.inverse(0, 0), 1.0 / (1.0 + kRidge), 1e-6);
}

TEST(KernelInverse, NoticesThatItHasDriftedAndMakesItselfAnew) {
  RandomStream random(3, "drift");
  Dictionary dictionary;
  for (int i = 0; i < 20; ++i) {
    dictionary.add(somewhere(random));
  }
  EXPECT_FALSE(dictionary.inverse.keep_exact(dictionary.matrix));
  // A sample the matrix never heard of leaves an inverse that isn't one.
  dictionary.inverse.remove(3);
  dictionary.inverse.add(dictionary.similarity({9.0, 9.0}).first(19), 1.0);
  EXPECT_GT(dictionary.inverse.residual(dictionary.matrix), 1e-3);
  EXPECT_TRUE(dictionary.inverse.keep_exact(dictionary.matrix));
  EXPECT_LT(dictionary.largest_error(), 1e-8);
}

}  // namespace
}  // namespace kelpie::kernel_inverse_test
