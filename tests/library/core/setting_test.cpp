// SPDX-License-Identifier: Apache-2.0
#include "kelpie/core/setting.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>

namespace kelpie::setting_test {
namespace {

enum class Colour { red, green };

struct Paint {
  double litres = 1.0;
  int coats = 2;
  Colour colour = Colour::red;
};

constexpr std::array<std::string_view, 2> kColours{"red", "green"};
const Setting<Paint> kLitres{"litres", "", &Paint::litres, {.low = 0.0, .open = true}};
const Setting<Paint> kCoats{"coats", "", &Paint::coats, {.low = 1.0, .high = 9.0}};
const Setting<Paint> kColour{"colour", "", choice_of<&Paint::colour, Paint>(kColours), {}};

std::string refusal(const auto& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Setting, TextGoesInAndComesOutTheSame) {
  Paint paint;
  kLitres.assign(paint, "0.30000000000000004");
  EXPECT_EQ(paint.litres, 0.30000000000000004);
  EXPECT_EQ(kLitres.get(paint), "0.30000000000000004");
  kCoats.assign(paint, "7");
  EXPECT_EQ(paint.coats, 7);
  kColour.assign(paint, "green");
  EXPECT_EQ(paint.colour, Colour::green);
  EXPECT_EQ(kColour.get(paint), "green");
}

TEST(Setting, RefusalsNameTheFieldAndWhatWouldBeRight) {
  Paint paint;
  EXPECT_EQ(refusal([&] { kColour.assign(paint, "gren"); }),
            "colour: 'gren' is no choice (did you mean 'green'?); there are red, green");
  EXPECT_EQ(refusal([&] { kCoats.assign(paint, "2.5"); }), "coats: '2.5' is not a whole number");
  EXPECT_EQ(refusal([&] { kLitres.assign(paint, "many"); }), "litres: 'many' is not a number");
  EXPECT_EQ(paint.coats, 2);
  paint.litres = 0.0;
  EXPECT_EQ(refusal([&] { kLitres.check(paint); }), "litres: 0 is out of range; it has to be > 0");
  paint.litres = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal([&] { kLitres.check(paint); }), "");
  paint.coats = 10;
  EXPECT_EQ(refusal([&] { kCoats.check(paint); }),
            "coats: 10 is out of range; it has to be 1 to 9");
}

}  // namespace
}  // namespace kelpie::setting_test
