// SPDX-License-Identifier: Apache-2.0
#include "core/quantile.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace kelpie::quantile_test {
namespace {

// Values of numpy.quantile.
TEST(Quantile, InterpolatesAsNumPyDoes) {
  std::vector<double> values{4.0, 1.0, 3.0, 2.0};
  EXPECT_DOUBLE_EQ(quantile(values, 0.0), 1.0);
  EXPECT_DOUBLE_EQ(quantile(values, 0.25), 1.75);
  EXPECT_DOUBLE_EQ(quantile(values, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(quantile(values, 0.99), 3.97);
  EXPECT_DOUBLE_EQ(quantile(values, 1.0), 4.0);
  std::vector<double> one{7.0};
  EXPECT_DOUBLE_EQ(quantile(one, 0.3), 7.0);
}

}  // namespace
}  // namespace kelpie::quantile_test
