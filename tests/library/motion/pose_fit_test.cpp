// SPDX-License-Identifier: Apache-2.0
#include "motion/pose_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "motion/pose_motion.hpp"
#include "support.hpp"

namespace kelpie::pose_fit_test {
namespace {

using testing::message_of;

constexpr double kRowS = 0.25;

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

// The vehicle's parameters at the places of a path, divided by the surge inertia.
Eigen::VectorXd path_parameters(const PlanarVehicle& truth) {
  const auto thrusters = static_cast<Eigen::Index>(truth.thrusters.size());
  Eigen::VectorXd p = Eigen::VectorXd::Zero(PathPlace::count(thrusters));
  p.head<4>() << truth.surge_inertia, truth.sway_inertia, truth.sway_yaw_inertia, truth.yaw_inertia;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const auto at = static_cast<std::size_t>(axis);
    p(static_cast<Eigen::Index>(PlanarPlace::linear_drag) + axis) = truth.linear_drag[at];
    p(static_cast<Eigen::Index>(PlanarPlace::quadratic_drag) + axis) = truth.quadratic_drag[at];
  }
  for (Eigen::Index i = 0; i < thrusters; ++i) {
    const PlanarThruster& one = truth.thrusters[static_cast<std::size_t>(i)];
    const Eigen::Index at = PathPlace::thruster(i);
    p(at + PathPlace::surge) = one.forward * std::cos(one.angle_rad);
    p(at + PathPlace::sway) = one.forward * std::sin(one.angle_rad);
    p(at + PathPlace::moment) = one.forward * one.arm_m;
  }
  p /= truth.surge_inertia;
  const auto inertia = static_cast<Eigen::Index>(PlanarPlace::yaw_inertia);
  const auto sway_inertia = static_cast<Eigen::Index>(PlanarPlace::sway_inertia);
  p(sway_inertia) = (p(sway_inertia) - 1.0) / p(inertia);
  for (const Eigen::Index yaw : {6, 9, 12, 16, 20, 24}) {  // moments: of drag, constant, thrusters
    p(yaw) /= p(inertia);
  }
  for (Eigen::Index i = 0; i < thrusters; ++i) {
    const PlanarThruster& one = truth.thrusters[static_cast<std::size_t>(i)];
    p(PathPlace::thruster(i) + PathPlace::ratio) = one.reverse / one.forward;
  }
  p.tail<3>() << 0.07, 0.05, -0.03;  // speeds are logged so much late [s], and the current [m/s]
  return p;
}

// `together`: all thrusters run alike.
PathPiece sines(double duration_s, bool together = false) {
  const auto rows = static_cast<Eigen::Index>(duration_s / kRowS);
  PathPiece piece{
      .times_s = Eigen::VectorXd::LinSpaced(rows, 0.0, kRowS * static_cast<double>(rows - 1)),
      .poses = Eigen::Matrix3Xd::Zero(3, rows),
      .speeds = Eigen::MatrixXd(3, rows)};
  constexpr double kTurn = 2.0 * std::numbers::pi;
  for (Eigen::Index row = 0; row < rows; ++row) {
    const double t = piece.times_s(row);
    const double first = 12.0 * std::sin(kTurn * t / 37.0);
    piece.speeds.col(row) << first, 12.0 * std::sin(kTurn * t / 29.0 + 1.0),
        10.0 * std::sin(kTurn * t / 43.0 + 2.0);
    if (together) {
      piece.speeds.col(row).setConstant(first);
    }
  }
  return piece;
}

// Driven in a current, measured with white noise and without a heading beyond ±π. A hole of 20 s
// without poses, and outliers.
PoseRows measured(const PlanarVehicle& truth, const PathPiece& piece, double noise_m) {
  const PathStates path =
      drive_piece(piece, path_parameters(truth), PoseState::Zero(), BetweenRows::ramps, {}, false);
  RandomStream random(7, "poses");
  PoseRows rows;
  for (const PlanarThruster& thruster : truth.thrusters) {
    rows.thrusters.push_back(thruster.name);
  }
  for (Eigen::Index row = 0; row < path.states.cols(); ++row) {
    const double t = piece.times_s(row);
    rows.times_s.push_back(t);
    const bool is_lost = t > 300.0 && t < 320.0;
    const double far = row % 400 == 0 ? 30.0 : 0.0;
    for (const double value :
         {path.states(0, row) + noise_m * random.normal() + far,
          path.states(1, row) + noise_m * random.normal(),
          std::remainder(path.states(2, row) + 0.003 * random.normal(), 2.0 * std::numbers::pi)}) {
      rows.poses.push_back(is_lost ? std::numeric_limits<double>::quiet_NaN() : value);
    }
    for (Eigen::Index i = 0; i < 3; ++i) {
      rows.speeds.push_back(piece.speeds(i, row));
    }
  }
  return rows;
}

TEST(PoseFit, FindsTheVehicleBehindPosesWithNoiseOfTenCentimetres) {
  const PlanarVehicle truth = vehicle();
  const PlanarFit fit =
      scaled_by_thrust(fit_poses(measured(truth, sines(900.0), 0.1)), {{"a", 0.026}});
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
  const PoseRows rows = measured(vehicle(), sines(600.0, true), 0.02);
  const std::string message = message_of<InputError>([&] { fit_poses(rows); });
  EXPECT_NE(message.find("too little excitation to tell"), std::string::npos) << message;
  EXPECT_NE(message.find(".forward"), std::string::npos) << message;
}

TEST(PoseFit, AMinuteIsTooShort) {
  const std::string message =
      message_of<InputError>([&] { fit_poses(measured(vehicle(), sines(60.0), 0.02)); });
  EXPECT_NE(message.find("too few poses"), std::string::npos) << message;
}

TEST(PoseMotion, DerivativesAgreeWithDifferences) {
  const PathPiece piece = sines(20.0);
  const Eigen::VectorXd p = path_parameters(vehicle());
  PoseState start;
  start << 1.0, 2.0, 0.4, 0.3, -0.1, 0.2;
  std::vector<Eigen::Index> sought;
  for (Eigen::Index place = 1; place < p.size(); ++place) {
    if (place != PathPlace::munk(3)) {  // which has a derivative alone
      sought.push_back(place);
    }
  }
  const auto count = static_cast<Eigen::Index>(sought.size());
  const Eigen::MatrixXd jacobian =
      drive_piece(piece, p, start, BetweenRows::ramps, sought, true).jacobian;
  const auto last_pose = [&](const Eigen::VectorXd& at, const PoseState& from) {
    return Eigen::Vector3d(drive_piece(piece, at, from, BetweenRows::ramps, {}, false)
                               .states.rightCols<1>()
                               .head<3>());
  };
  for (Eigen::Index k = 0; k < count + 6; ++k) {
    Eigen::VectorXd up = p, down = p;
    PoseState from_up = start, from_down = start;
    const double step =
        k < count ? 1e-5 * std::max(0.01, std::abs(p(sought[static_cast<std::size_t>(k)]))) : 1e-5;
    if (k < count) {
      up(sought[static_cast<std::size_t>(k)]) += step;
      down(sought[static_cast<std::size_t>(k)]) -= step;
    } else {
      from_up(k - count) += step;
      from_down(k - count) -= step;
    }
    const Eigen::Vector3d slope =
        (last_pose(up, from_up) - last_pose(down, from_down)) / (2 * step);
    const Eigen::Vector3d told = jacobian.bottomRows<3>().col(k);
    EXPECT_LT((slope - told).norm(), 1e-4 * (1.0 + told.norm())) << k;
  }
}

}  // namespace
}  // namespace kelpie::pose_fit_test
