// SPDX-License-Identifier: Apache-2.0
#include "svr/squared_exponential.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "kelpie/core/random.hpp"

namespace kelpie::squared_exponential_test {
namespace {

TEST(SquaredExponential, RowAgreesWithTheFormulaForEveryLengthAndStart) {
  RandomStream random(1, "kernel");
  for (const std::size_t dimension : {1U, 3U, 6U, 17U}) {
    SampleStore samples(dimension, 600);
    std::vector<double> x(dimension);
    const auto draw = [&] {
      for (double& value : x) {
        value = random.normal();
      }
    };
    while (samples.size() < samples.capacity()) {
      draw();
      samples.push_back(x);
    }
    draw();
    const SquaredExponential kernel(0.3);
    for (const std::size_t first : {0U, 1U, 255U}) {
      std::vector<double> row(samples.size() - first);
      kernel.row(x, samples, first, row);
      std::vector<double> other(dimension);
      for (std::size_t i = 0; i < row.size(); ++i) {
        samples.get(first + i, other);
        double square = 0.0;
        for (std::size_t k = 0; k < dimension; ++k) {
          square += (x[k] - other[k]) * (x[k] - other[k]);
        }
        ASSERT_NEAR(row[i], std::exp(-0.3 * square), 1e-14);
      }
    }
  }
}

TEST(SquaredExponential, IsAsAccurateAsItSays) {
  SampleStore samples(1, 20'000);
  for (std::size_t i = 0; i < samples.capacity(); ++i) {
    const double value = std::sqrt(i < 10'000 ? 1e-7 * static_cast<double>(i * i)
                                              : 0.0754 * static_cast<double>(i - 10'000));
    samples.push_back({&value, 1});
  }
  const double zero = 0.0;
  std::vector<double> row(samples.size());
  SquaredExponential(1.0).row({&zero, 1}, samples, row);
  for (std::size_t i = 0; i < row.size(); ++i) {
    const double x = samples.coordinate(0)[i];
    const double exponent = -(x * x);
    const auto exact = std::exp(static_cast<long double>(exponent));
    if (exact < 0x1p-1021L) {
      ASSERT_EQ(row[i], 0.0);
      continue;
    }
    ASSERT_LE(std::abs(static_cast<long double>(row[i]) - exact),
              exact * (3.0L - exponent) * 0x1p-52L)
        << exponent;
  }
}

TEST(SquaredExponential, ExpansionIsTheWeightedSumOfTheRow) {
  RandomStream random(3, "expansion");
  for (std::size_t n = 0; n < 40; ++n) {
    SampleStore samples(3, 40);
    std::vector<double> weights;
    for (std::size_t i = 0; i < n; ++i) {
      samples.push_back(std::vector{random.normal(), random.normal(), random.normal()});
      weights.push_back(random.normal());
    }
    const std::vector<double> z{0.1, 0.2, -0.3};
    std::vector<double> row(n);
    const SquaredExponential kernel(0.4);
    kernel.row(z, samples, row);
    double sum = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      sum += weights[i] * row[i];
    }
    EXPECT_NEAR(kernel.expansion(z, samples, weights), sum, 1e-13);
  }
}

TEST(SquaredExponential, TheGradientIsThatOfTheWeightedSum) {
  RandomStream random(4, "gradient");
  for (const std::size_t dimension : {1U, 3U, 64U}) {
    for (std::size_t n = 0; n < 40; ++n) {
      SampleStore samples(dimension, 40);
      std::vector<double> weights;
      std::vector<double> x(dimension);
      const auto draw = [&] {
        for (double& value : x) {
          value = random.normal() / std::sqrt(static_cast<double>(dimension));
        }
      };
      for (std::size_t i = 0; i < n; ++i) {
        draw();
        samples.push_back(x);
        weights.push_back(random.normal());
      }
      draw();
      double sum = 0.0;
      std::vector<double> slopes(dimension);
      std::vector<double> other(dimension);
      for (std::size_t i = 0; i < n; ++i) {
        samples.get(i, other);
        double square = 0.0;
        for (std::size_t k = 0; k < dimension; ++k) {
          square += (x[k] - other[k]) * (x[k] - other[k]);
        }
        const double coarse = 0.7 * std::exp(-0.4 * square);
        const double fine = 0.3 * std::exp(-32.0 * 0.4 * square);
        sum += weights[i] * (coarse + fine);
        for (std::size_t k = 0; k < dimension; ++k) {
          slopes[k] -= weights[i] * 0.8 * (coarse + 32.0 * fine) * (x[k] - other[k]);
        }
      }
      std::vector<double> gradient(dimension);
      EXPECT_NEAR(
          SquaredExponential(0.4).expansion_with_gradient(x, samples, weights, 0.7, 0.3, gradient),
          sum, 1e-13);
      for (std::size_t k = 0; k < dimension; ++k) {
        ASSERT_NEAR(gradient[k], slopes[k], 1e-12) << n << " samples, coordinate " << k;
      }
    }
  }
}

TEST(SquaredExponential, FarAndEqualPointsGiveZeroAndOne) {
  SampleStore samples(1, 3);
  for (const double value : {0.0, 1e3, 1e200}) {
    samples.push_back({&value, 1});
  }
  std::vector<double> row(3);
  const double zero = 0.0;
  SquaredExponential(100.0).row({&zero, 1}, samples, row);
  EXPECT_EQ(row[0], 1.0);
  EXPECT_LT(row[1], 1e-300);
  EXPECT_GE(row[1], 0.0);
  EXPECT_LT(row[2], 1e-300);
  EXPECT_GE(row[2], 0.0);
}

}  // namespace
}  // namespace kelpie::squared_exponential_test
