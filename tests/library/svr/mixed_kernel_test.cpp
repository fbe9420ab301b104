// SPDX-License-Identifier: Apache-2.0
#include "svr/mixed_kernel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "kelpie/core/random.hpp"

namespace kelpie::mixed_kernel_test {
namespace {

TEST(MixedKernel, IsTheSumOfItsParts) {
  RandomStream random(5, "mixed");
  for (const std::size_t terms : {0U, 1U, 4U, 7U}) {
    const MixedKernel kernel(0.4, {.s = 1.5, .fine = terms == 4 ? 0.7 : 0.0, .lambda = 0.2}, 3,
                             terms);
    SampleStore samples(kernel.dimension(), 50);
    const auto draw = [&] {
      std::vector<double> x(kernel.dimension());
      for (double& value : x) {
        value = 0.3 * random.normal();
      }
      return x;
    };
    std::vector<std::vector<double>> points;
    for (int i = 0; i < 50; ++i) {
      points.push_back(draw());
      samples.push_back(points.back());
    }
    const std::vector<double> x = draw();
    std::vector<double> similarity(50);
    std::vector<double> row(50);
    kernel.similarity(x, samples, similarity);
    kernel.row(x, samples, similarity, row);
    const auto expected = [&](const std::vector<double>& other) {
      double square = 0.0;
      double product = 0.0;
      for (std::size_t k = 0; k < x.size(); ++k) {
        square += k < 3 ? std::pow(x[k] - other[k], 2) : 0.0;
        product += k < 3 ? 0.0 : x[k] * other[k];
      }
      const double fine = kernel.weights().fine * std::exp(-32.0 * 0.4 * square);
      return 1.5 * std::exp(-0.4 * square) + fine + 0.2 * product;
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_NEAR(row[i], expected(points[i]), 1e-13);
    }
    EXPECT_NEAR(kernel.self(x), expected(x), 1e-13);
  }
}

}  // namespace
}  // namespace kelpie::mixed_kernel_test
