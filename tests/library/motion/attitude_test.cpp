// SPDX-License-Identifier: Apache-2.0
#include "kelpie/motion/attitude.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "kelpie/core/random.hpp"
#include "kelpie/motion/term_set.hpp"

namespace kelpie::attitude_test {
namespace {

using Names = std::vector<std::string>;

TEST(Attitude, IsFoundByNames) {
  const Attitude plain = find_attitude(Names{"u", "roll", "pitch", "yaw", "n1"});
  EXPECT_EQ(plain.roll, 1U);
  EXPECT_EQ(plain.pitch, 2U);
  EXPECT_EQ(plain.headings, std::vector<std::size_t>{3});
  EXPECT_TRUE(plain.contains(2));
  EXPECT_FALSE(plain.contains(0));
  EXPECT_FALSE(plain.contains(4));
  EXPECT_EQ(find_attitude(Names{"phi", "THETA"}).pitch, 1U);
  EXPECT_EQ(find_attitude(Names{"/imu/attitude/roll_angle"}).roll, 0U);
  EXPECT_EQ(find_attitude(Names{"att.Pitch_rad"}).pitch_unit, 1.0);
  EXPECT_NEAR(find_attitude(Names{"pitch_deg"}).pitch_unit, std::numbers::pi / 180.0, 1e-16);
  EXPECT_NEAR(find_attitude(Names{"roll"}, true).roll_unit, std::numbers::pi / 180.0, 1e-16);
}

// Rates, commands and a propeller's pitch are no angles of the vehicle; q alone is a rate.
TEST(Attitude, OtherNamesAreNone) {
  const Names names{"p",      "q",          "r",  "roll_rate", "cmd.roll", "joy/pitch",
                    "pitch1", "prop_pitch", "qx", "qy",        "qz"};
  const Attitude found = find_attitude(names);
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_FALSE(found.contains(i)) << names[i];
  }
}

// Of a vehicle with such letters in its name.
TEST(Attitude, LettersWithinAWordAreNoOtherMessage) {
  for (const char* const name : {"orca4/attitude.roll", "aircraft.attitude.roll", "level.roll",
                                 "accurate_imu.roll", "/enjoy/imu/roll"}) {
    EXPECT_EQ(find_attitude(Names{name}).roll, 0U) << name;
  }
  for (const char* const name : {"rc.roll", "mavros/rc/in.roll", "cmd_vel.roll", "body_rates.roll",
                                 "vehicle_attitude_setpoint.roll", "angular_velocity.roll"}) {
    EXPECT_FALSE(find_attitude(Names{name}).roll) << name;
  }
}

TEST(Attitude, DegreesAreToldByTheirSize) {
  const Attitude both = find_attitude(Names{"roll", "pitch"});
  EXPECT_EQ(unit_of_angles(both, std::vector{6.28, 1.57}), AngleUnit::radians);
  EXPECT_EQ(unit_of_angles(both, std::vector{0.3, 1.7}), AngleUnit::degrees);
  EXPECT_EQ(unit_of_angles(both, std::vector{45.0, 1.0}), AngleUnit::degrees);
  EXPECT_EQ(unit_of_angles(both, std::vector{45.0, 100.0}), AngleUnit::none);
  EXPECT_EQ(unit_of_angles({}, std::vector{500.0, 500.0}), AngleUnit::radians);
}

// Roll and pitch, the same in degrees, and the quaternion of them with any heading.
TEST(Attitude, RestoringTermsAreTheDirectionOfGravityInTheBody) {
  const Names names{"roll", "pitch", "qx", "qy", "qz", "qw", "roll_deg", "pitch_deg"};
  const auto terms = [&](std::size_t first, std::size_t count) {
    const Names some(names.begin() + static_cast<std::ptrdiff_t>(first),
                     names.begin() + static_cast<std::ptrdiff_t>(first + count));
    return TermSet::from("auto", some, 0);
  };
  const std::vector<TermSet> sets{terms(0, 2), terms(2, 4), terms(6, 2)};
  RandomStream random(1, "attitude");
  for (int i = 0; i < 20; ++i) {
    const double roll = 3.0 * random.normal();
    const double pitch = 0.5 * random.normal();
    const double yaw = 3.0 * random.normal();
    const auto [a, b] = std::pair(std::cos(roll / 2), std::sin(roll / 2));
    const auto [c, d] = std::pair(std::cos(pitch / 2), std::sin(pitch / 2));
    const auto [e, f] = std::pair(std::cos(yaw / 2), std::sin(yaw / 2));
    const std::vector<std::vector<double>> x{
        {roll, pitch},
        {b * c * e - a * d * f, a * d * e + b * c * f, a * c * f - b * d * e,
         a * c * e + b * d * f},
        {roll * 180.0 / std::numbers::pi, pitch * 180.0 / std::numbers::pi}};
    const std::vector wanted{std::sin(pitch), std::cos(pitch) * std::sin(roll),
                             std::cos(pitch) * std::cos(roll)};
    for (std::size_t k = 0; k < sets.size(); ++k) {
      ASSERT_EQ(sets[k].size(), 3U);
      std::vector<double> values(3);
      sets[k].evaluate(x[k], values);
      const double sign = k == 1 ? -1.0 : 1.0;  // 2 (x z − w y) = −sin θ
      EXPECT_NEAR(sign * values[0], wanted[0], 1e-12);
      EXPECT_NEAR(values[1], wanted[1], 1e-12);
      EXPECT_NEAR(values[2], wanted[2], 1e-12);
    }
  }
}

// Angles multiply with nothing, and a heading is in no term.
TEST(Attitude, AutoHasRestoringTermsOfAnAttitudeOnly) {
  const Names names{"u", "n", "roll", "yaw"};
  const TermSet set = TermSet::from("auto", names, 1);
  Names texts;
  for (std::size_t k = 0; k < set.size(); ++k) {
    texts.push_back(set.text(k));
  }
  EXPECT_EQ(texts, (Names{"u", "n", "u*|u|", "n*|n|", "sin(roll)", "cos(roll)", "u*n"}));
  EXPECT_EQ(set.without_products(), 6U);
  EXPECT_EQ(set.attitude(), (std::vector<std::size_t>{2, 3}));
  EXPECT_TRUE(TermSet::from("quadratic", names, 1).attitude().empty());
}

// Where gravity points in the body: turned by −ω, whatever the angles are called and measured in.
TEST(Attitude, MovesWithTheAngularVelocities) {
  constexpr double kStep = 1e-6;
  const std::array<Names, 3> vehicles{Names{"p", "q", "r", "roll", "pitch"},
                                      Names{"p", "q", "r", "roll_deg", "pitch_deg"},
                                      Names{"p", "q", "r", "qx", "qy", "qz", "qw"}};
  for (const Names& names : vehicles) {
    const AttitudeMotion motion(find_attitude(names), names, std::array<std::size_t, 3>{0, 1, 2});
    const TermSet terms = TermSet::from("auto", names, 3);
    const auto gravity = [&](const std::vector<double>& x) {
      std::vector<double> phi(terms.size());
      terms.evaluate(x, phi);
      const std::size_t first = terms.without_products() - 3;
      const double sign = names.size() == 7 ? 1.0 : -1.0;  // of sin θ
      return std::array{sign * phi[first], phi[first + 1], phi[first + 2]};
    };
    RandomStream random(1, "attitude");
    for (int i = 0; i < 50; ++i) {
      std::vector<double> x(names.size());
      double length = 0.0;
      for (std::size_t k = 0; k < x.size(); ++k) {
        x[k] = random.normal() * (names[3] == "roll_deg" && k > 2 ? 30.0 : 0.5);
        length += k > 2 ? x[k] * x[k] : 0.0;
      }
      for (std::size_t k = 3; names.size() == 7 && k < x.size(); ++k) {
        x[k] /= std::sqrt(length);
      }
      std::vector<double> rates(motion.inputs().size());
      motion.rates(x, rates);
      std::vector<double> later = x;
      for (std::size_t k = 0; k < rates.size(); ++k) {
        later[motion.inputs()[k]] += kStep * rates[k];
      }
      const auto g = gravity(x);
      const auto next = gravity(later);
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t a = (k + 1) % 3;
        const std::size_t b = (k + 2) % 3;
        EXPECT_NEAR((next[k] - g[k]) / kStep, g[a] * x[b] - g[b] * x[a], 1e-4) << names[3];
      }
    }
  }
}

// Heave and pitch rate alone: pitch moves with the model, roll comes with the log. Surge, sway and
// yaw rate alone: both come with the log.
TEST(Attitude, MovesAsFarAsTheModelKnowsTheVelocities) {
  const Names diving{"w", "q", "delta", "phi", "theta"};
  const std::array<std::size_t, 2> states{0, 1};
  EXPECT_EQ(AttitudeMotion(find_attitude(diving), diving, states).inputs(),
            std::vector<std::size_t>{4});
  const Names planar{"u", "v", "r", "n", "phi", "theta"};
  const std::array<std::size_t, 3> plane{0, 1, 2};
  EXPECT_TRUE(AttitudeMotion(find_attitude(planar), planar, plane).inputs().empty());
  EXPECT_FALSE(attitude_for("quadratic", planar).contains(4));
  EXPECT_TRUE(attitude_for("fossen", planar).contains(4));
}

}  // namespace
}  // namespace kelpie::attitude_test
