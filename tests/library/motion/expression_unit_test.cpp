// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "kelpie/motion/expression.hpp"

namespace kelpie::expression_unit_test {
namespace {

// The unit of a formula over u [m/s], r [rad/s], th1 [rev/s] and raw, of which nothing is known;
// "?" where it can't be told.
std::string unit(const std::string& formula) {
  const std::vector<std::string> columns{"u", "r", "th1", "raw"};
  const std::vector<std::optional<Unit>> units{Unit::parse("m/s"), Unit::parse("rad/s"),
                                               Unit::parse("rev/s"), std::nullopt};
  const std::optional<Unit> found = Expression::parse(formula, columns).unit(units);
  return found ? found->text() : "?";
}

TEST(ExpressionUnit, OfProductsAndPowers) {
  EXPECT_EQ(unit("u"), "m s^-1");
  EXPECT_EQ(unit("u*|u|"), "m^2 s^-2");
  EXPECT_EQ(unit("u*r"), "m rad s^-2");
  EXPECT_EQ(unit("-u/r"), "m rad^-1");
  EXPECT_EQ(unit("2*r^3"), "rad^3 s^-3");
  EXPECT_EQ(unit("sqrt(u^2 + u*u)"), "m s^-1");
  EXPECT_EQ(unit("1/u"), "s m^-1");
  EXPECT_EQ(unit("sign(u)*th1"), "rev s^-1");
}

TEST(ExpressionUnit, ZeroIsOfAnyUnit) {
  EXPECT_EQ(unit("max(th1,0)^2"), "rev^2 s^-2");
  EXPECT_EQ(unit("-min(0,th1)^2"), "rev^2 s^-2");
  EXPECT_EQ(unit("max(raw,0)"), "?");
}

TEST(ExpressionUnit, IsNotGuessedWhereItCannotBeTold) {
  for (const std::string formula :
       {"u + r", "u - 1", "max(u,th1)", "raw", "u*raw", "raw + raw", "sin(u)", "tanh(raw)"}) {
    EXPECT_EQ(unit(formula), "?") << formula;
  }
  EXPECT_EQ(unit("cos(u/u)"), "1");
}

}  // namespace
}  // namespace kelpie::expression_unit_test
