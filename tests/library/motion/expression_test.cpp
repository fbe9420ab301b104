// SPDX-License-Identifier: Apache-2.0
#include "kelpie/motion/expression.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "kelpie/core/error.hpp"

namespace kelpie::expression_test {
namespace {

const std::vector<std::string> kColumns{"u", "v", "th1", "/odom:twist.x"};

double value(const std::string& text, std::vector<double> x = {3.0, -2.0, 0.5, 7.0}) {
  return Expression::parse(text, kColumns)(x);
}

std::string complaint(const std::string& text) {
  try {
    Expression::parse(text, kColumns);
  } catch (const InputError& error) {
    return error.what();
  }
  return "taken";
}

TEST(Expression, MeansWhatItSays) {
  EXPECT_EQ(value("u"), 3.0);
  EXPECT_EQ(value("1 + 2 * u - v / 4"), 7.5);
  EXPECT_EQ(value("(1 + 2) * u"), 9.0);
  EXPECT_EQ(value("u - 1 - 1"), 1.0);
  EXPECT_EQ(value("12 / u / 2"), 2.0);
  EXPECT_EQ(value("v*|v|"), -4.0);
  EXPECT_EQ(value("|u*|v||"), 6.0);
  EXPECT_EQ(value("-u^2"), -9.0);
  EXPECT_EQ(value("v^2"), 4.0);
  EXPECT_EQ(value("--u"), 3.0);
  EXPECT_EQ(value("u*-v"), 6.0);
  EXPECT_EQ(value("max(th1,0)^2"), 0.25);
  EXPECT_EQ(value("-min(v, 0)^2"), -4.0);
  EXPECT_EQ(value("sign(v) + sign(0) + abs(v)"), 1.0);
  EXPECT_DOUBLE_EQ(value("sqrt(u) * tanh(v) + sin(u) * cos(th1)"),
                   std::sqrt(3.0) * std::tanh(-2.0) + std::sin(3.0) * std::cos(0.5));
  EXPECT_EQ(value("'/odom:twist.x' * 2"), 14.0);
  EXPECT_EQ(value("1.5e1"), 15.0);
  EXPECT_TRUE(std::isinf(value("1/(u-3)")));
}

TEST(Expression, SaysWhatIsWrongAndWhere) {
  EXPECT_EQ(
      complaint("u*tth1"),
      "'u*tth1': 'tth1' is no column (did you mean 'th1'?); there are u, v, th1, /odom:twist.x "
      "(at character 3)");
  EXPECT_EQ(complaint("u*"), "'u*': ends where a column or number is expected (at character 3)");
  EXPECT_EQ(complaint(""), "'': ends where a column or number is expected (at character 1)");
  EXPECT_EQ(complaint("(u"), "'(u': ')' is missing (at character 3)");
  EXPECT_EQ(complaint("|u"), "'|u': '|' is missing (at character 3)");
  EXPECT_EQ(complaint("max(u)"), "'max(u)': ',' is missing (at character 6)");
  EXPECT_EQ(complaint("u v"), "'u v': 'v' is not expected here (at character 3)");
  EXPECT_EQ(complaint("u^v"), "'u^v': a number >= 0 is expected (at character 3)");
  EXPECT_NE(complaint("'it''s'''+u").find(": 'it's'' is no column"), std::string::npos);
  EXPECT_EQ(complaint("'u''"), "''u''': a quote is not closed (at character 5)");
  EXPECT_EQ(complaint("'u"), "''u': a quote is not closed (at character 2)");
  EXPECT_EQ(complaint("u § v"), "'u § v': '\xC2' is not expected here (at character 3)");
  EXPECT_NE(complaint(std::string(500, '(') + "u").find("nested too deeply"), std::string::npos);
  EXPECT_NE(complaint(std::string(500, '-') + "u").find("nested too deeply"), std::string::npos);
  EXPECT_NE(complaint(std::string(500, '|') + "u").find("nested too deeply"), std::string::npos);
  std::string tower = "u";
  for (int i = 0; i < 40; ++i) {
    tower = "u*(1+" + tower + ")";
  }
  EXPECT_NE(complaint(tower).find("nested too deeply"), std::string::npos);
}

}  // namespace
}  // namespace kelpie::expression_test
