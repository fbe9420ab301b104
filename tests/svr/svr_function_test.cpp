// SPDX-License-Identifier: Apache-2.0
#include "kelpie/svr/svr_function.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "kelpie/core/random.hpp"

namespace kelpie {
namespace {

TEST(SvrFunction, IsTheExpansionOverSamplesWithAWeight) {
  RandomStream random(31, "function");
  SampleStore samples(2, 700);
  std::vector<double> beta;
  std::vector<std::vector<double>> points;
  for (int i = 0; i < 700; ++i) {
    points.push_back({random.normal(), random.normal()});
    samples.push_back(points.back());
    beta.push_back(i % 3 == 0 ? 0.0 : random.normal());
  }
  SvrFunction function(SquaredExponential(0.7), 2, 700);
  function.assign(samples, beta, -0.25);
  EXPECT_EQ(function.support_vectors().size(), 466U);
  const std::vector<double> z{0.3, -1.2};
  double expected = -0.25;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double a = z[0] - points[i][0];
    const double b = z[1] - points[i][1];
    expected += beta[i] * std::exp(-0.7 * (a * a + b * b));
  }
  EXPECT_NEAR(function(z), expected, 1e-10);
}

TEST(SvrFunction, WithoutSupportVectorsIsItsBias) {
  SvrFunction function(SquaredExponential(1.0), 1, 4);
  const double z = 2.0;
  function.assign(SampleStore(1, 4), {}, 1.5);
  EXPECT_EQ(function({&z, 1}), 1.5);
}

}  // namespace
}  // namespace kelpie
