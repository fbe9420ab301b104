// SPDX-License-Identifier: Apache-2.0
// What Expression::slope says is compared with what the value does as a column grows.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "kelpie/core/random.hpp"
#include "kelpie/motion/expression.hpp"

namespace kelpie::expression_value_test {
namespace {

const std::vector<std::string> kColumns{"u", "v", "w"};

double slope(const std::string& text, const std::vector<double>& x, std::size_t column = 0) {
  return Expression::parse(text, kColumns).slope(x, column).slope;
}

// To the right; the curvature is what it is off by.
double quotient(const Expression& formula, std::vector<double> x, std::size_t column) {
  const double before = formula(x);
  const double step = 1e-7;
  x[column] += step;
  return (formula(x) - before) / step;
}

TEST(ExpressionSlope, IsWhatTheValueDoesAsAColumnGrows) {
  RandomStream random(1, "slopes");
  for (const char* const text : {"u*|u|", "-u^2 * v / (w + 3)", "max(u, v) - min(u*v, w) * abs(w)",
                                 "sqrt(|u*v| + 1)^3", "sin(u)*cos(v) + tanh(u - w)",
                                 "(u^2 + 1)^0.7", "sign(u) * v * u^0 + 3 - u^1", "v/2", "7"}) {
    const Expression formula = Expression::parse(text, kColumns);
    for (int trial = 0; trial < 50; ++trial) {
      const std::vector<double> x{random.normal(), random.normal(), random.normal()};
      for (std::size_t column = 0; column < x.size(); ++column) {
        const auto [value, found] = formula.slope(x, column);
        EXPECT_EQ(value, formula(x)) << text;
        EXPECT_NEAR(found, quotient(formula, x, column), 3e-5 * (1.0 + std::abs(found))) << text;
      }
    }
  }
}

TEST(ExpressionSlope, AtAKinkIsTheOneToTheRight) {
  const std::vector<double> origin{0.0, 0.0, 0.0};
  for (const char* const text :
       {"|u|", "-|u|", "|-3*u|", "max(u,0)", "max(0,u)", "min(u,0)", "min(0,-u)", "max(-u, 2*u)",
        "|max(u,0) - 2*u|", "u*|u|", "|u|*2 - u", "min(|u|, u)", "sqrt(u^2 + 0)*0", "u^1"}) {
    const Expression formula = Expression::parse(text, kColumns);
    EXPECT_NEAR(formula.slope(origin, 0).slope, quotient(formula, origin, 0), 1e-6) << text;
  }
  EXPECT_EQ(slope("sign(u)", origin), 0.0);
  EXPECT_EQ(slope("u^2", origin), 0.0);
  EXPECT_EQ(slope("u^0", origin), 0.0);
}

TEST(ExpressionSlope, WithoutABoundIsNotFinite) {
  EXPECT_FALSE(std::isfinite(slope("sqrt(u)", {0.0, 1.0, 1.0})));
  EXPECT_FALSE(std::isfinite(slope("u^0.5", {0.0, 1.0, 1.0})));
  EXPECT_FALSE(std::isfinite(slope("1/u", {0.0, 1.0, 1.0})));
  EXPECT_FALSE(std::isfinite(slope("sqrt(u)", {-1.0, 1.0, 1.0})));
  // What doesn't move has none, however steep the function is.
  EXPECT_EQ(slope("sqrt(u)", {0.0, 1.0, 1.0}, 1), 0.0);
}

TEST(ExpressionSlope, ColumnsAreListedOnce) {
  const Expression formula = Expression::parse("w*u*|w| + 2", kColumns);
  EXPECT_EQ(std::vector(formula.columns().begin(), formula.columns().end()),
            (std::vector<std::size_t>{0, 2}));
}

}  // namespace
}  // namespace kelpie::expression_value_test
