// SPDX-License-Identifier: Apache-2.0
#include "kelpie/motion/unit.hpp"

#include <gtest/gtest.h>

#include <string>

#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::unit_test {
namespace {

std::string text(const std::string& unit) {
  return Unit::parse(unit).text();
}

std::string complaint(const std::string& unit) {
  return testing::message_of<InputError>([&] { Unit::parse(unit); });
}

TEST(Unit, IsPrintedAsPowersPositiveOnesFirst) {
  EXPECT_EQ(text("m/s^2"), "m s^-2");
  EXPECT_EQ(text("1/s"), "s^-1");
  EXPECT_EQ(text("1"), "1");
  EXPECT_EQ(text("m/m"), "1");
  EXPECT_EQ(text("s^-2 m"), "m s^-2");
  EXPECT_EQ(text("m^0"), "1");
}

TEST(Unit, ACoefficientIsTargetOverTermSimplified) {
  const Unit target = Unit::parse("m/s^2");
  const Unit thrust = Unit::parse("rev/s").power(2.0);
  EXPECT_EQ((target / thrust).text(), "m rev^-2");
  EXPECT_EQ((target / Unit::parse("m/s").power(2.0)).text(), "m^-1");
  EXPECT_EQ((target / Unit::parse("rad^2/s^2")).text(), "m rad^-2");
  EXPECT_EQ((target / target).text(), "1");
}

TEST(Unit, EveryUsualSpellingMeansTheSame) {
  for (const std::string spelling : {"N m/(rad/s)^2", "N*m/(rad/s)^2", "N·m·rad⁻²·s²",
                                     "(N m) (s/rad)^2", " N  m s^2 / rad / rad "}) {
    EXPECT_EQ(text(spelling), "N m s^2 rad^-2") << spelling;
  }
  EXPECT_EQ(text("m^0.5"), "m^0.5");
  EXPECT_EQ(text("°/s"), "° s^-1");
}

TEST(Unit, WhatItPrintsItReads) {
  for (const std::string unit : {"m s^-2", "1", "kg m^2 s^-3", "% s^-0.5"}) {
    EXPECT_EQ(text(unit), unit);
  }
}

TEST(Unit, UnitsOfMotionHaveAFactorToTheSi) {
  const auto in_si = [](const char* unit) {
    const auto [si, factor] = Unit::parse(unit).in_si();
    return std::pair(si.text(), factor);
  };
  using Si = std::pair<std::string, double>;
  EXPECT_EQ(in_si("deg/s").first, "rad s^-1");
  EXPECT_NEAR(in_si("deg/s").second, 0.0174533, 1e-7);
  EXPECT_EQ(in_si("cm/s^2"), (Si{"m s^-2", 0.01}));
  EXPECT_EQ(in_si("mm/s"), (Si{"m s^-1", 0.001}));
  EXPECT_NEAR(in_si("km/h").second, 1.0 / 3.6, 1e-12);
  EXPECT_EQ(in_si("knots").first, "m s^-1");
  EXPECT_EQ(in_si("g"), (Si{"m s^-2", 9.80665}));
  EXPECT_NEAR(in_si("rad/min").second, 1.0 / 60.0, 1e-12);
  EXPECT_EQ(in_si("m/s"), (Si{"m s^-1", 1.0}));
  for (const char* const of_commands : {"us", "rev/min", "rpm", "V", "%", "ms", "h"}) {
    EXPECT_EQ(in_si(of_commands).second, 1.0) << of_commands;
  }
}

TEST(Unit, SaysWhatIsWrongWithATextThatIsNone) {
  EXPECT_EQ(complaint("m/s2"), "'m/s2' is not a unit such as m/s^2: a power is written with '^'");
  EXPECT_NE(complaint("").find("it ends where a name is expected"), std::string::npos);
  EXPECT_NE(complaint("m/").find("it ends where a name is expected"), std::string::npos);
  EXPECT_NE(complaint("m/(s").find("')' is missing"), std::string::npos);
  EXPECT_NE(complaint("m^x").find("a number has to follow '^'"), std::string::npos);
  EXPECT_NE(complaint("m)").find("')' is not expected"), std::string::npos);
  EXPECT_NE(complaint("2m").find("'2' is not expected"), std::string::npos);
  EXPECT_NE(complaint(std::string(100'000, '(')), "");
}

}  // namespace
}  // namespace kelpie::unit_test
