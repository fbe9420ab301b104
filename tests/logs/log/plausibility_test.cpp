// SPDX-License-Identifier: Apache-2.0
#include "log/plausibility.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "kelpie/core/error.hpp"
#include "support.hpp"

namespace kelpie::plausibility_test {
namespace {

constexpr double kRate = 5.0;
constexpr std::size_t kRows = 1500;
constexpr double kDegree = 180.0 / std::numbers::pi;

// Five minutes of a vehicle in surge and yaw: velocities wander, accelerations are their slopes,
// with noise of `noise` of an acceleration's size.
log::Dataset drive(double noise = 0.1) {
  log::Dataset data;
  data.source = "log.csv";
  data.input_names = {"u", "r", "n"};
  data.target_names = {"udot", "rdot"};
  data.time_column = "t";
  data.rate_hz = kRate;
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  double u = 0.0;
  double r = 0.0;
  double push = 0.0;
  double turn = 0.0;
  for (std::size_t i = 0; i < kRows; ++i) {
    push += (0.3 * normal(random) - push) / kRate;
    turn += (0.3 * normal(random) - turn) / kRate;
    const double udot = push - 0.3 * u;
    const double rdot = turn - 0.3 * r;
    data.inputs.insert(data.inputs.end(), {u, r, push});
    data.targets.insert(data.targets.end(), {udot + 0.05 * noise * normal(random),
                                             rdot + 0.05 * noise * normal(random)});
    data.times_s.push_back(static_cast<double>(i) / kRate);
    data.configurations.push_back(0);
    u += udot / kRate;
    r += rdot / kRate;
  }
  return data;
}

log::Dataset with_input(std::size_t column, double factor) {
  log::Dataset data = drive();
  for (std::size_t i = column; i < data.inputs.size(); i += data.input_names.size()) {
    data.inputs[i] *= factor;
  }
  return data;
}

log::Dataset with_target(std::size_t column, double factor) {
  log::Dataset data = drive();
  for (std::size_t i = column; i < data.targets.size(); i += data.target_names.size()) {
    data.targets[i] *= factor;
  }
  return data;
}

log::Dataset with_clock(double factor) {
  log::Dataset data = drive();
  for (double& t : data.times_s) {
    t *= factor;
  }
  data.rate_hz /= factor;
  return data;
}

std::string text_of(const std::vector<log::Mistake>& mistakes) {
  std::string text;
  for (const log::Mistake& one : mistakes) {
    text += log::mistake_text(one) + "\n";
  }
  return text;
}

std::string mistake_of(const log::Dataset& data) {
  return text_of(log::target_mistakes(data, "auto"));
}

void expect_mistake(const log::Dataset& data, const std::string& words) {
  const std::string text = mistake_of(data);
  EXPECT_NE(text.find(words), std::string::npos) << text;
}

// By sampling: a wide window shrinks and shifts a derivative of a quick velocity.
TEST(Plausibility, DerivativesOfTheVelocitiesAreRight) {
  log::Dataset data = with_input(1, kDegree);
  EXPECT_FALSE(log::target_mistakes(data, "auto").empty());
  data.derived = {"rdot"};
  EXPECT_TRUE(log::target_mistakes(data, "auto").empty());
}

TEST(Plausibility, AccelerationsOfTheVelocitiesAreNoMistake) {
  EXPECT_EQ(mistake_of(drive()), "");
  EXPECT_TRUE(log::clock_mistakes(drive()).empty());
}

TEST(Plausibility, NoiseIsNoMistake) {
  EXPECT_EQ(mistake_of(drive(100.0)), "");
}

TEST(Plausibility, NamesUnits) {
  expect_mistake(with_input(1, kDegree),
                 "r is in degrees per second, rdot in rad/s² (rdot is 0.01");
  expect_mistake(with_input(1, kDegree), "; --units r=deg/s converts");
  expect_mistake(with_target(1, kDegree), "rdot is in degrees per second squared, r in rad/s");
  expect_mistake(with_input(0, 100.0), "u is in cm/s, udot in m/s²");
  expect_mistake(with_target(0, 1.0 / 9.80665), "udot is in g, u in m/s");
  expect_mistake(with_input(0, 3.6), "u is in km/h, udot in m/s²");
  expect_mistake(with_input(0, 1.0 / 0.5144), "u is in knots, udot in m/s²");
  expect_mistake(with_target(0, 7.0),
                 "udot is 6.93 times as large as the slope of u: the two have different units");
}

TEST(Plausibility, NamesClocks) {
  expect_mistake(with_clock(1e3), "time stamps are in ms");
  expect_mistake(with_clock(1e3), "; --units t=ms converts the stamps");
  expect_mistake(with_clock(1e9), "time stamps are in ns");
  expect_mistake(with_clock(2.5), "2.5 times as many rows per second as said");
  expect_mistake(with_clock(2.5), "; --rate 5");
}

TEST(Plausibility, NamesSigns) {
  expect_mistake(with_target(0, -1.0), "udot has the sign opposite to the slope of u");
  EXPECT_EQ(mistake_of(with_target(0, -1.0)).find("rdot"), std::string::npos);
}

TEST(Plausibility, NamesALateTarget) {
  log::Dataset data = drive();
  const std::vector<double> targets = data.targets;
  constexpr std::size_t kLate = 10;  // rows: 2 s
  for (std::size_t row = kLate; row < kRows; ++row) {
    data.targets[2 * row] = targets[2 * (row - kLate)];
  }
  expect_mistake(data, "udot comes 2 s later than u changes");
}

// Over five seconds a slow swing two seconds late looks as if in time.
TEST(Plausibility, NamesALateTargetThatLongWindowsHide) {
  log::Dataset data = drive();
  const auto wave = [](double time, double period) {
    return 2.0 * std::numbers::pi * time / period;
  };
  for (std::size_t i = 0; i < kRows; ++i) {
    const double now = data.times_s[i];
    const double late = now - 2.0;
    data.inputs[3 * i] = 30.0 / (2.0 * std::numbers::pi) * std::sin(wave(now, 30.0)) +
                         0.8 * 4.1 / (2.0 * std::numbers::pi) * std::sin(wave(now, 4.1));
    data.targets[2 * i] = std::cos(wave(late, 30.0)) + 0.8 * std::cos(wave(late, 4.1));
  }
  expect_mistake(data, "udot comes 2 s later than u changes");
}

TEST(Plausibility, AColumnWithoutAVelocityHasNoCheck) {
  log::Dataset data = with_target(0, 100.0);
  data.target_names = {"force", "moment"};
  data.input_names = {"a", "b", "n"};
  EXPECT_EQ(mistake_of(data), "");
}

TEST(Plausibility, AGapOrAChangeOfConfigurationIsNoMotion) {
  log::Dataset data = drive();
  for (std::size_t row = kRows / 2; row < kRows; ++row) {
    data.times_s[row] += 3600.0;
    data.configurations[row] = 1;
    data.inputs[3 * row] += 50.0;  // an offset that no acceleration explains
  }
  EXPECT_EQ(mistake_of(data), "");
}

TEST(Plausibility, TellsOfRepeatedStampsAndRefusesMany) {
  log::Dataset data = drive();
  for (std::size_t row = 500; row < 511; ++row) {
    data.times_s[row] = data.times_s[500];
  }
  std::vector<log::Mistake> found = log::clock_mistakes(data);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found.front().what,
            "10 of 1500 rows have the time stamp of the row before, the first at 100 s");
  EXPECT_FALSE(found.front().is_refused);
  for (std::size_t row = 0; row < kRows; ++row) {
    data.times_s[row] = std::floor(static_cast<double>(row) / kRate);  // whole seconds
  }
  found = log::clock_mistakes(data);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found.front().is_refused);
}

TEST(Plausibility, TellsOfAGapAndOfAHighRate) {
  log::Dataset data = drive();
  for (std::size_t row = kRows / 2; row < kRows; ++row) {
    data.times_s[row] += 3600.0;
  }
  EXPECT_EQ(text_of(log::clock_mistakes(data)).substr(0, 34), "no rows for 60 min after 149.8 s; ");
  data = drive();
  data.rate_hz = 2000.0;
  EXPECT_EQ(text_of(log::clock_mistakes(data)).substr(0, 25), "2000 rows per second are ");
}

TEST(Plausibility, NamesAFewValuesFarBeyondAllOthers) {
  log::Dataset data = drive();
  ASSERT_TRUE(log::clock_mistakes(data).empty());
  double usual = 0.0;
  for (std::size_t row = 0; row < kRows; ++row) {
    usual = std::max(usual, std::abs(data.inputs[3 * row]));
  }
  data.inputs[3 * 700] = -8.0 * usual;
  EXPECT_TRUE(log::clock_mistakes(data).empty()) << "a rare manoeuvre";
  data.inputs[3 * 700] = -100.0 * usual;
  data.inputs[3 * 900] = -100.0 * usual;
  const std::vector<log::Mistake> found = log::clock_mistakes(data);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found.front().what.substr(0, 25), "u: 2 rows, the farthest a");
  EXPECT_EQ(log::clock_mistakes(with_input(0, 100.0)).size(), 0U) << "all of them are";
  EXPECT_FALSE(found.front().is_refused);
}

}  // namespace
}  // namespace kelpie::plausibility_test
