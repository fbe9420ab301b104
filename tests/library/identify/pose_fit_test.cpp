// SPDX-License-Identifier: Apache-2.0
#include "identify/pose_fit.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "support.hpp"

namespace kelpie::pose_fit_test {
namespace {

using testing::message_of;

PlanarVehicle vehicle() {
  return {.surge_inertia = 85.0,
          .sway_inertia = 130.0,
          .sway_yaw_inertia = 2.0,
          .yaw_inertia = 8.5,
          .linear_drag = {14.0, 15.0, 1.3},
          .quadratic_drag = {15.0, 59.0, 1.0},
          .constant_force = {0.0, 0.0, 0.0},
          .thrusters = {{"a", 0.026, 0.020, 0.1, -0.32},
                        {"b", 0.026, 0.020, -0.1, 0.32},
                        {"c", 0.036, 0.027, -0.5 * std::numbers::pi, 0.4}}};
}

using Pose = std::array<double, 3>;  // x, y, heading

std::vector<double> sines(double t) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  return {12.0 * std::sin(kTurn * t / 37.0), 12.0 * std::sin(kTurn * t / 29.0 + 1.0),
          10.0 * std::sin(kTurn * t / 43.0 + 2.0)};
}

std::vector<double> together(double t) {
  return std::vector<double>(3, sines(t).front());
}

// Driven in a current by the midpoint rule, measured with white noise, with
// a hole of 20 s without poses and some outliers. Speeds are logged a little late.
PoseRows measured(double duration_s, double noise_m, std::vector<double> (*speeds)(double)) {
  constexpr double kStepS = 0.025;
  constexpr int kStepsPerRow = 10;
  constexpr double kLateS = 0.07;
  const PlanarVehicle truth = vehicle();
  RandomStream random(7, "poses");
  PoseRows rows{.thrusters = {"a", "b", "c"}, .times_s = {}, .poses = {}, .speeds = {}};
  PlanarVector v{};
  Pose pose{};
  const auto slope = [](const Pose& at, const PlanarVector& nu) {
    return Pose{nu[0] * std::cos(at[2]) - nu[1] * std::sin(at[2]) + 0.05,
                nu[0] * std::sin(at[2]) + nu[1] * std::cos(at[2]) - 0.03, nu[2]};
  };
  const auto moved = [](const auto& from, const auto& by, double h) {
    return std::array{from[0] + h * by[0], from[1] + h * by[1], from[2] + h * by[2]};
  };
  for (int step = 0; step < static_cast<int>(duration_s / kStepS); ++step) {
    const double t = kStepS * step;
    if (step % kStepsPerRow == 0) {
      rows.times_s.push_back(t);
      const bool is_lost = t > 300.0 && t < 320.0;
      const double far = step % 4000 == 0 ? 30.0 : 0.0;
      for (const double value :
           {pose[0] + noise_m * random.normal() + far, pose[1] + noise_m * random.normal(),
            pose[2] + 0.003 * random.normal()}) {
        rows.poses.push_back(is_lost ? std::numeric_limits<double>::quiet_NaN() : value);
      }
      for (const double speed : speeds(t - kLateS)) {
        rows.speeds.push_back(speed);
      }
    }
    const double half_s = 0.5 * kStepS;
    const PlanarVector middle = moved(v, truth.acceleration(v, speeds(t)), half_s);
    const Pose halfway = moved(pose, slope(pose, v), half_s);
    v = moved(v, truth.acceleration(middle, speeds(t + half_s)), kStepS);
    pose = moved(pose, slope(halfway, middle), kStepS);
  }
  return rows;
}

TEST(PoseFit, FindsTheVehicleBehindPosesWithNoiseOfTenCentimetres) {
  const PlanarVehicle truth = vehicle();
  const PlanarFit fit = scaled_by_thrust(fit_poses(measured(900.0, 0.1, sines)), {{"a", 0.026}});
  const PlanarVehicle found = fit.vehicle();
  EXPECT_NEAR(found.surge_inertia, 85.0, 3.0);
  EXPECT_NEAR(found.sway_inertia, 130.0, 4.0);
  EXPECT_NEAR(found.yaw_inertia, 8.5, 0.4);
  constexpr PlanarVector kUsual{0.2, 0.1, 0.3};
  for (std::size_t axis = 0; axis < kPlanarAxes; ++axis) {
    const auto drag = [&](const PlanarVehicle& of) {
      return of.linear_drag[axis] + kUsual[axis] * of.quadratic_drag[axis];
    };
    EXPECT_NEAR(drag(found), drag(truth), 0.05 * drag(truth)) << axis;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(found.thrusters[i].forward, truth.thrusters[i].forward, 1e-3) << i;
    EXPECT_NEAR(found.thrusters[i].reverse, truth.thrusters[i].reverse, 1e-3) << i;
    EXPECT_NEAR(found.thrusters[i].angle_rad, truth.thrusters[i].angle_rad, 0.03) << i;
    EXPECT_NEAR(found.thrusters[i].arm_m, truth.thrusters[i].arm_m, 0.03) << i;
  }
  int held = 0;
  const PlanarVector inertias{85.0, 130.0, 2.0};
  for (std::size_t i = 0; i < inertias.size(); ++i) {
    held += std::abs(fit.parameters[i].value - inertias[i]) < 3.0 * fit.parameters[i].error ? 1 : 0;
  }
  EXPECT_EQ(held, 3);
  EXPECT_LT(fit.misfit, 2.0);
}

TEST(PoseFit, ThrustersThatRunTogetherAreRefusedByName) {
  const PoseRows rows = measured(600.0, 0.02, together);
  const std::string message = message_of<InputError>([&] { fit_poses(rows); });
  EXPECT_NE(message.find("too little excitation to tell"), std::string::npos) << message;
  EXPECT_NE(message.find(".forward"), std::string::npos) << message;
}

TEST(PoseFit, AMinuteIsTooShort) {
  const std::string message =
      message_of<InputError>([&] { fit_poses(measured(60.0, 0.02, sines)); });
  EXPECT_NE(message.find("too few poses"), std::string::npos) << message;
}

}  // namespace
}  // namespace kelpie::pose_fit_test
