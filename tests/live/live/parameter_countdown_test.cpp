// SPDX-License-Identifier: Apache-2.0
#include "live/parameter_countdown.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "support.hpp"

namespace kelpie::parameter_countdown_test {
namespace {

constexpr double kRowS = 0.25;

live::Configuration configuration() {
  live::Configuration configuration;
  configuration.plan.inputs = {"u", "v", "r", "th1", "th2", "th3"};
  configuration.plan.targets = {"udot", "vdot", "rdot"};
  configuration.plan.rate_hz = 1.0 / kRowS;
  return configuration;
}

// Rows of a vehicle whose commands change every 4 s, measured with noise.
class Swimmer {
 public:
  std::array<double, 6> next() {
    std::array<double, 6> row{};
    for (double end = t + kRowS; t < end - 1e-9; t += kStepS) {
      if (t >= held_until_s_) {
        held_until_s_ += 4.0;
        std::ranges::generate(speeds_, [&] { return random_.uniform(-12.0, 12.0); });
      }
      const PlanarVector slope = vehicle_.acceleration(v_, speeds_);
      for (std::size_t i = 0; i < v_.size(); ++i) {
        v_[i] += kStepS * slope[i];
      }
    }
    for (std::size_t i = 0; i < 3; ++i) {
      row[i] = v_[i] + 0.01 * random_.normal();
      row[3 + i] = speeds_[i];
    }
    return row;
  }
  double t = 0.0;

 private:
  static constexpr double kStepS = 0.01;
  PlanarVehicle vehicle_{.surge_inertia = 85.0,
                         .sway_inertia = 95.0,
                         .sway_yaw_inertia = 2.0,
                         .yaw_inertia = 8.5,
                         .linear_drag = {14.0, 15.0, 1.3},
                         .quadratic_drag = {15.0, 59.0, 1.0},
                         .constant_force = {},
                         .thrusters = {{"th1", 0.026, 0.020, 0.1, -0.32},
                                       {"th2", 0.026, 0.020, -0.1, 0.32},
                                       {"th3", 0.036, 0.027, -0.5 * std::numbers::pi, 0.4}}};
  RandomStream random_{3, "rows"};
  std::vector<double> speeds_{0.0, 0.0, 0.0};
  double held_until_s_ = 0.0;
  PlanarVector v_{};
};

// Seconds; 0 where none are told.
double told_s(const std::string& countdown) {
  std::smatch found;
  if (!std::regex_search(countdown, found, std::regex(" → ± 2 % in about (\\d+) (s|min)\\)"))) {
    return 0.0;
  }
  return std::stod(found[1]) * (found[2] == "min" ? 60.0 : 1.0);
}

// At the rate of the last minute, in which information (1 / interval²) came.
TEST(ParameterCountdown, TellsHowLongTheRestTakes) {
  live::ParameterCountdown countdown(
      configuration(), {.tell = {"surge_inertia"}, .percent = 2.0, .thrust = {{"th1", 0.026}}});
  Swimmer swimmer;
  live::Output nobody;
  std::vector<std::pair<double, double>> fits;  // time, information
  live::LearnerHealth health;
  int told = 0;
  while (health.parameters_known == 0 && swimmer.t < 900.0) {
    const std::array<double, 6> row = swimmer.next();
    countdown.update(row, swimmer.t, false, nobody);
    countdown.report(health);
    const double interval =
        health.parameters.empty() ? std::nan("") : health.parameters[0].interval;
    const double information = 1.0 / (interval * interval);
    if (interval > 0.0 && (fits.empty() || fits.back().second != information)) {
      fits.emplace_back(swimmer.t, information);
    }
    if (const double left_s = told_s(health.countdown); left_s > 0.0) {
      ++told;
      const auto [now_s, now] = fits.back();
      const auto [before_s, before] =
          *std::ranges::find_if(fits, [&](const auto& fit) { return fit.first >= now_s - 60.0; });
      const double expected_s = (2500.0 - now) * (now_s - before_s) / (now - before);
      EXPECT_GE(left_s, expected_s - 1e-6) << now_s;
      EXPECT_LE(left_s, expected_s + (left_s < 120.0 ? 10.0 : 60.0)) << now_s;
    }
  }
  ASSERT_EQ(health.parameters_known, 1U) << health.countdown;
  EXPECT_EQ(told_s(health.countdown), 0.0) << health.countdown;
  EXPECT_GT(told, 40);
}

TEST(ParameterCountdown, NamesTheWayToSixAxes) {
  live::Configuration six = configuration();
  six.plan.inputs = {"u", "v", "w", "p", "q", "r", "phi", "theta", "m1", "m2"};
  six.plan.targets = {"udot", "vdot", "wdot", "pdot", "qdot", "rdot"};
  const std::string refused =
      testing::message_of<InputError>([&] { live::ParameterCountdown(six, {}); });
  EXPECT_NE(refused.find("--tell: identifies vehicles in the plane"), std::string::npos) << refused;
  EXPECT_NE(refused.find("kelpie identify --vehicle FILE"), std::string::npos) << refused;
  six.plan.inputs = {"u", "v", "r", "phi"};  // in the plane
  six.plan.targets = {"udot", "vdot", "rdot"};
  const std::string other =
      testing::message_of<InputError>([&] { live::ParameterCountdown(six, {}); });
  EXPECT_EQ(other.find("--vehicle"), std::string::npos) << other;
  EXPECT_NE(other.find("phi"), std::string::npos) << other;
}

}  // namespace
}  // namespace kelpie::parameter_countdown_test
