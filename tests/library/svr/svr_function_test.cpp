// SPDX-License-Identifier: Apache-2.0
#include "svr/svr_function.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "kelpie/core/random.hpp"

namespace kelpie::svr_function_test {
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
  SvrFunction function({SquaredExponential(0.7), 2}, 700);
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

// One weight per term says what all support vectors say together.
TEST(SvrFunction, TermWeightsAreTheExpansionsLinearPart) {
  RandomStream random(32, "terms");
  const MixedKernel kernel(0.5, {.s = 0.8, .fine = 0.4, .lambda = 0.3}, 2, 3);
  SampleStore samples(5, 40);
  std::vector<double> beta;
  for (int i = 0; i < 40; ++i) {
    samples.push_back(std::vector{random.normal(), random.normal(), random.normal(),
                                  random.normal(), random.normal()});
    beta.push_back(i % 4 == 0 ? 0.0 : random.normal());
  }
  SvrFunction function(kernel, 40);
  function.assign(samples, beta, 0.1);
  const std::vector<double> x{0.2, -0.4, 1.0, 2.0, -3.0};
  std::vector<double> similarity(40);
  std::vector<double> row(40);
  kernel.similarity(x, samples, similarity);
  kernel.row(x, samples, similarity, row);
  double expected = 0.1;
  for (std::size_t i = 0; i < 40; ++i) {
    expected += beta[i] * row[i];
  }
  EXPECT_NEAR(function(x), expected, 1e-12);
}

TEST(SvrFunction, WithoutSupportVectorsIsItsBias) {
  SvrFunction function({SquaredExponential(1.0), 1}, 4);
  const double z = 2.0;
  function.assign(SampleStore(1, 4), {}, 1.5);
  EXPECT_EQ(function({&z, 1}), 1.5);
}

}  // namespace
}  // namespace kelpie::svr_function_test
