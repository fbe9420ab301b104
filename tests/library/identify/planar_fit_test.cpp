// SPDX-License-Identifier: Apache-2.0
#include "kelpie/identify/planar_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "support.hpp"

namespace kelpie::planar_fit_test {
namespace {

using testing::message_of;

constexpr double kStepS = 0.05;
constexpr int kStepsPerRow = 5;
constexpr double kTurn = 2.0 * std::numbers::pi;

PlanarVehicle vehicle() {
  return {.surge_inertia = 85.0,
          .sway_inertia = 95.0,
          .sway_yaw_inertia = 2.0,
          .yaw_inertia = 8.5,
          .linear_drag = {14.0, 15.0, 1.3},
          .quadratic_drag = {15.0, 59.0, 1.0},
          .constant_force = {0.3, -0.2, 0.02},
          .thrusters = {{"a", 0.026, 0.020, 0.1, -0.32},
                        {"b", 0.026, 0.020, -0.1, 0.32},
                        {"c", 0.036, 0.027, -0.5 * std::numbers::pi, 0.4}}};
}

using Drive = std::function<std::vector<double>(double t)>;

std::vector<double> sines(double t) {
  return {12.0 * std::sin(kTurn * t / 37.0), 12.0 * std::sin(kTurn * t / 29.0 + 1.0),
          10.0 * std::sin(kTurn * t / 43.0 + 2.0)};
}

// Drives it by classical Runge-Kutta; velocities are measured with white noise.
PlanarRows drive(const PlanarVehicle& truth, double duration_s, double noise, const Drive& speeds,
                 std::uint64_t seed = 1) {
  RandomStream random(seed, "velocities");
  PlanarRows rows;
  for (const PlanarThruster& thruster : truth.thrusters) {
    rows.thrusters.push_back(thruster.name);
  }
  PlanarVector v{};
  const auto moved = [](const PlanarVector& from, const PlanarVector& slope, double h) {
    return PlanarVector{from[0] + h * slope[0], from[1] + h * slope[1], from[2] + h * slope[2]};
  };
  const auto steps = static_cast<int>(duration_s / kStepS);
  for (int step = 0; step < steps; ++step) {
    const double t = kStepS * step;
    if (step % kStepsPerRow == 0) {
      rows.times_s.push_back(t);
      for (const double velocity : v) {
        rows.velocities.push_back(velocity + noise * random.normal());
      }
      for (const double speed : speeds(t)) {
        rows.speeds.push_back(speed);
      }
    }
    const PlanarVector k1 = truth.acceleration(v, speeds(t));
    const PlanarVector k2 =
        truth.acceleration(moved(v, k1, 0.5 * kStepS), speeds(t + 0.5 * kStepS));
    const PlanarVector k3 =
        truth.acceleration(moved(v, k2, 0.5 * kStepS), speeds(t + 0.5 * kStepS));
    // Before a step at the end.
    const PlanarVector k4 = truth.acceleration(moved(v, k3, kStepS), speeds(t + 0.999 * kStepS));
    for (std::size_t i = 0; i < v.size(); ++i) {
      v[i] += kStepS / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
    }
  }
  return rows;
}

std::vector<double> values_of(const PlanarVehicle& truth) {
  std::vector<double> values{truth.surge_inertia, truth.sway_inertia, truth.sway_yaw_inertia,
                             truth.yaw_inertia};
  for (const PlanarVector& list : {truth.linear_drag, truth.quadratic_drag, truth.constant_force}) {
    values.insert(values.end(), list.begin(), list.end());
  }
  for (const PlanarThruster& thruster : truth.thrusters) {
    values.insert(values.end(),
                  {thruster.forward, thruster.reverse, thruster.angle_rad, thruster.arm_m});
  }
  return values;
}

TEST(PlanarFit, FindsTheVehicleThatDroveWithoutNoise) {
  const PlanarFit fit =
      scaled_by_thrust(fit_planar(drive(vehicle(), 900.0, 0.0, sines)), {{"a", 0.026}});
  const std::vector<double> truth = values_of(vehicle());
  ASSERT_EQ(fit.parameters.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_NEAR(fit.parameters[i].value, truth[i], 2e-3 * std::abs(truth[i]) + 1e-4)
        << fit.parameters[i].name;
    EXPECT_NE(fit.parameters[i].state, ParameterState::not_told) << fit.parameters[i].name;
  }
}

// New speeds every 2.5 s, as of a program that holds its commands.
std::vector<double> held(double t) {
  RandomStream random(static_cast<std::uint64_t>(std::floor(t / 2.5 + 1e-6)), "steps");
  return {random.uniform(-12.0, 12.0), random.uniform(-12.0, 12.0), random.uniform(-10.0, 10.0)};
}

// A row has the speeds from the row on, or those until the row.
TEST(PlanarFit, StepsOfCommandsAreNoRamps) {
  for (const bool is_until : {false, true}) {
    PlanarRows rows = drive(vehicle(), 900.0, 1e-3, held);
    if (is_until) {
      rows.speeds.insert(rows.speeds.begin(), 3, 0.0);
      rows.speeds.resize(3 * rows.rows());
    }
    const PlanarFit fit = scaled_by_thrust(fit_planar(rows), {{"a", 0.026}});
    EXPECT_LT(fit.misfit, 2.0);
    const PlanarVehicle found = fit.vehicle();
    EXPECT_NEAR(found.surge_inertia, 85.0, 1.0) << is_until;
    EXPECT_NEAR(found.sway_inertia, 95.0, 1.0) << is_until;
    EXPECT_NEAR(found.yaw_inertia, 8.5, 0.3) << is_until;
    EXPECT_NEAR(found.linear_drag[2], 1.3, 0.06) << is_until;
  }
}

TEST(PlanarFit, IntervalsHoldTheTruthUnderNoise) {
  const std::vector<double> truth = values_of(vehicle());
  int held = 0;
  int all = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const PlanarFit fit =
        scaled_by_inertia(fit_planar(drive(vehicle(), 900.0, 2e-3, sines, seed)), 85.0, 0.0);
    for (std::size_t i = 1; i < truth.size(); ++i) {
      const FittedParameter& found = fit.parameters[i];
      held += std::abs(found.value - truth[i]) < 1.645 * found.error ? 1 : 0;
      ++all;
      EXPECT_LT(std::abs(found.value - truth[i]), 6.0 * found.error) << found.name;
    }
  }
  EXPECT_GT(held, 0.8 * all);
}

TEST(PlanarFit, AFewAbsurdRowsChangeLittle) {
  PlanarRows rows = drive(vehicle(), 900.0, 1e-3, sines);
  for (const std::size_t row : {100U, 1100U, 2500U}) {
    rows.velocities[3 * row + 1] = 1e6;
    rows.velocities[3 * row + 30] += 3.0;
  }
  const PlanarFit fit = scaled_by_inertia(fit_planar(rows), 85.0, 0.0);
  EXPECT_NEAR(fit.vehicle().sway_inertia, 95.0, 3.0);
  EXPECT_NEAR(fit.vehicle().linear_drag[0], 14.0, 1.0);
}

// Drag that a free fit would find negative is 0, and says so; the rest is still found.
TEST(PlanarFit, SignsHoldAndAreTold) {
  PlanarVehicle truth = vehicle();
  truth.quadratic_drag[0] = -6.0;
  const PlanarFit fit = scaled_by_inertia(fit_planar(drive(truth, 900.0, 1e-3, sines)), 85.0, 0.0);
  const FittedParameter& drag = fit.parameters[PlanarPlace::quadratic_drag];
  EXPECT_EQ(drag.value, 0.0);
  EXPECT_EQ(drag.state, ParameterState::at_bound);
  EXPECT_NEAR(fit.vehicle().sway_inertia, 95.0, 5.0);
}

TEST(PlanarFit, AThrusterThatNeverReversesHasNoReverse) {
  const auto forwards = [](double t) {
    std::vector<double> speeds = sines(t);
    speeds[0] = 7.0 + 0.4 * speeds[0];
    return speeds;
  };
  const PlanarFit fit = fit_planar(drive(vehicle(), 900.0, 5e-4, forwards));
  EXPECT_EQ(fit.parameters[PlanarPlace::thruster(0) + 1].state, ParameterState::not_told);
  EXPECT_EQ(fit.parameters[PlanarPlace::thruster(0)].state, ParameterState::identified);
  EXPECT_EQ(fit.parameters[PlanarPlace::thruster(1) + 1].state, ParameterState::identified);
}

TEST(PlanarFit, TooLittleExcitationIsRefusedByName) {
  const auto straight = [](double t) {
    return std::vector<double>{10.0 + std::sin(t / 9.0), 10.0 + std::sin(t / 9.0), 0.0};
  };
  PlanarVehicle even = vehicle();
  even.sway_yaw_inertia = 0.0;
  even.constant_force = {};
  const PlanarRows rows = drive(even, 900.0, 1e-3, straight);
  const std::string message = message_of<InputError>([&] { fit_planar(rows); });
  EXPECT_NE(message.find("too little excitation to tell"), std::string::npos) << message;
  EXPECT_NE(message.find("c.forward"), std::string::npos) << message;
  const PlanarRows few = drive(vehicle(), 30.0, 0.0, sines);
  EXPECT_NE(message_of<InputError>([&] { fit_planar(few); }).find("too few rows"),
            std::string::npos);
}

TEST(PlanarFit, TheScaleIsOfForcesAloneAndItsErrorIsInAll) {
  const PlanarFit ratios = fit_planar(drive(vehicle(), 600.0, 1e-3, sines));
  EXPECT_EQ(ratios.parameters[PlanarPlace::surge_inertia].value, 1.0);
  const PlanarFit sure = scaled_by_inertia(ratios, 85.0, 0.0);
  const PlanarFit vague = scaled_by_inertia(ratios, 85.0, 8.5);
  for (std::size_t i = 0; i < ratios.parameters.size(); ++i) {
    const bool is_place = i >= PlanarPlace::thrusters && (i - PlanarPlace::thrusters) % 4 >= 2;
    const double factor = is_place ? 1.0 : 85.0;
    EXPECT_DOUBLE_EQ(sure.parameters[i].value, factor * ratios.parameters[i].value);
    EXPECT_NEAR(
        vague.parameters[i].error,
        std::hypot(sure.parameters[i].error, is_place ? 0.0 : 0.1 * sure.parameters[i].value),
        1e-9 + 1e-6 * sure.parameters[i].error);
  }
  EXPECT_EQ(
      scaled_by_thrust(ratios, {{"b", 0.026}}).parameters[PlanarPlace::thruster(1)].error < 1e-9,
      true);
  EXPECT_NE(message_of<InputError>([&] {
              scaled_by_thrust(ratios, {{"d", 1.0}});
            }).find("'d' is no thruster"),
            std::string::npos);
  EXPECT_THROW(scaled_by_thrust(ratios, {{"a", 0.0}}), InputError);
}

TEST(PlanarFit, TellsAccelerationsFromOtherTargets) {
  const PlanarRows rows = drive(vehicle(), 300.0, 1e-3, sines);
  std::vector<double> accelerations;
  for (std::size_t i = 0; i < rows.rows(); ++i) {
    const PlanarVector a = vehicle().acceleration(rows.velocity(i), rows.speed(i));
    accelerations.insert(accelerations.end(), {a[0], rows.velocity(i)[1], 57.3 * a[2]});
  }
  const auto checks = check_accelerations(rows, accelerations);
  EXPECT_GT(checks[0].correlation, 0.95);
  EXPECT_NEAR(checks[0].slope, 1.0, 0.05);
  EXPECT_LT(std::abs(checks[1].correlation), 0.5);
  EXPECT_NEAR(checks[2].slope, 57.3, 3.0);
}

}  // namespace
}  // namespace kelpie::planar_fit_test
