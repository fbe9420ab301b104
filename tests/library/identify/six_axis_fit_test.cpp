// SPDX-License-Identifier: Apache-2.0
#include "identify/six_axis_fit.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "identify/expected_six_axis_fit.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "support.hpp"

namespace kelpie::six_axis_fit_test {
namespace {

using testing::message_of;

std::vector<PlacedThruster> placed_thrusters() {
  std::vector<PlacedThruster> thrusters;
  const double half = std::sqrt(0.5);
  for (int i = 0; i < 8; ++i) {
    const double x = i < 2 || i == 4 || i == 5 ? 0.13 : -0.13;
    const double y = i % 2 == 0 ? 0.2 : -0.2;
    const Triple direction =
        i < 4 ? Triple{x > 0.0 ? half : -half, y > 0.0 ? -half : half, 0.0} : Triple{0.0, 0.0, 1.0};
    thrusters.push_back({"T" + std::to_string(i + 1), {x, y, 0.0}, direction});
  }
  return thrusters;
}

// A small vehicle by Euler's method: eight thrusters driven by sines, roll and pitch nearly at rest
// under a large righting moment, rates with noise of 3 mrad/s.
SixAxisRows small_vehicle(std::uint64_t seed) {
  constexpr double kStepS = 0.02;
  constexpr int kStepsPerRow = 5;
  constexpr int kRows = 3000;
  constexpr double kTurn = 2.0 * std::numbers::pi;
  using Six = Eigen::Vector<double, 6>;
  const Six mass{{18.0, 24.0, 26.0, 0.4, 0.45, 0.5}};
  const Six linear{{4.0, 6.0, 5.0, 0.1, 0.1, 0.1}};
  const Six quadratic{{18.0, 22.0, 36.0, 1.5, 1.5, 1.5}};
  RandomStream random(seed, "small vehicle");
  SixAxisRows rows;
  rows.thrusters = placed_thrusters();
  Eigen::Matrix<double, 6, 8> arms;  // force and moment of a newton
  for (Eigen::Index i = 0; i < 8; ++i) {
    const PlacedThruster& thruster = rows.thrusters[static_cast<std::size_t>(i)];
    const Eigen::Vector3d direction = Eigen::Map<const Eigen::Vector3d>(thruster.direction.data());
    const Eigen::Vector3d place = Eigen::Map<const Eigen::Vector3d>(thruster.position_m.data());
    arms.col(i) << direction, place.cross(direction);
  }
  Eigen::Matrix<double, 8, 3> turns;
  Eigen::Matrix<double, 8, 3> phases;
  for (Eigen::Index i = 0; i < 24; ++i) {
    turns(i) = kTurn * random.uniform(0.03, 0.25);
    phases(i) = random.uniform(0.0, kTurn);
  }
  Six v = Six::Zero();
  double roll = 0.0;
  double pitch = 0.0;
  for (int step = 0; step < kRows * kStepsPerRow; ++step) {
    const double t = kStepS * step;
    Eigen::Vector<double, 8> command =
        (turns * t + phases).array().sin().matrix() * Eigen::Vector3d(0.33, 0.3, 0.23);
    command.tail(4) *= 0.6;
    Six force = arms * (9.0 * command.cwiseProduct(command.cwiseAbs())) - linear.cwiseProduct(v) -
                quadratic.cwiseProduct(v.cwiseProduct(v.cwiseAbs()));
    const Eigen::Vector3d down(-std::sin(pitch), std::cos(pitch) * std::sin(roll),
                               std::cos(pitch) * std::cos(roll));
    force(3) -= 25.0 * down(1);
    force(4) += 25.0 * down(0);
    const Six momentum = mass.cwiseProduct(v);
    const Eigen::Vector3d rates = v.tail(3);
    force.head(3) -= rates.cross(momentum.head<3>());
    force.tail(3) -= v.head<3>().cross(momentum.head<3>()) + rates.cross(momentum.tail<3>());
    if (step % kStepsPerRow == 0) {
      rows.times_s.push_back(t);
      for (const double value : v) {
        rows.velocities.push_back(value + 0.003 * random.normal());
      }
      rows.down.insert(rows.down.end(), down.begin(), down.end());
      rows.commands.insert(rows.commands.end(), command.begin(), command.end());
    }
    v += kStepS * force.cwiseQuotient(mass);
    const double turn = std::sin(roll) * rates(1) + std::cos(roll) * rates(2);
    pitch += kStepS * (std::cos(roll) * rates(1) - std::sin(roll) * rates(2));
    roll += kStepS * (rates(0) + std::tan(pitch) * turn);
  }
  return rows;
}

// A first lag of 0.6 s, where there is none: unchecked steps of the fit led to inertias a
// thousandth of the vehicle's, with intervals of next to nothing.
TEST(SixAxisFit, AWrongFirstLagDoesNotShrinkTheVehicle) {
  const SixAxisFit fit =
      scaled_by_inertia(fit_six_axes(small_vehicle(1), {.start = {.lag_s = 0.6}}), 18.0, 0.0);
  const SixVector truth{18.0, 24.0, 26.0, 0.4, 0.45, 0.5};
  for (std::size_t axis = 0; axis < kSixAxes; ++axis) {
    EXPECT_NEAR(fit.parameters[axis].value, truth[axis], 0.4 * truth[axis]) << axis;
  }
  EXPECT_LT(fit.misfit, 10.0);
}

TEST(SixAxisFit, AThrusterThatPushesBackwardsIsRefusedByName) {
  SixAxisRows rows = small_vehicle(1);
  for (std::size_t i = 4; i < rows.commands.size(); i += rows.thrusters.size()) {
    rows.commands[i] = -rows.commands[i];
  }
  const std::string message = message_of<InputError>([&] { fit_six_axes(rows); });
  EXPECT_NE(message.find("no thrust of T5"), std::string::npos) << message;
  EXPECT_NE(message.find("with the direction of T5 reversed"), std::string::npos) << message;
  EXPECT_NE(message.find("check places and directions"), std::string::npos) << message;
  EXPECT_EQ(message_of<InputError>([&] { ExpectedSixAxisFit{rows, {}}; }), message) << "a plan";
}

}  // namespace
}  // namespace kelpie::six_axis_fit_test
