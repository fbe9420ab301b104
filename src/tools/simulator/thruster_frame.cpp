// SPDX-License-Identifier: Apache-2.0
#include "simulator/thruster_frame.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "simulator/decomposition.hpp"

namespace kelpie::simulator {
namespace {

struct Place {
  std::array<double, 3> place;      // in halves of length, width, height
  std::array<double, 3> direction;  // of any length
};

struct Frame {
  const char* name;
  std::vector<Place> motors;
};

// Of a BlueROV2 Heavy (von Benzon et al. 2022, Table A1; Blue Robotics' drawing of the frame).
const Eigen::Vector3d kHeavySize{0.457, 0.436, 0.254};
constexpr double kHeavyMass = 13.5;
constexpr double kX = 0.156 / 0.2285;  // of the horizontal thrusters
constexpr double kY = 0.111 / 0.218;
constexpr double kZ = 0.085 / 0.127;
constexpr double kVerticalX = 0.120 / 0.2285;

// Signs of AP_Motors6DOF.cpp: throttle counts upwards, roll, pitch and yaw as in FRD.
const std::vector<Frame>& frames() {
  static const std::vector<Place> vectored = {{{kX, kY, kZ}, {-1, 1, 0}},
                                              {{kX, -kY, kZ}, {-1, -1, 0}},
                                              {{-kX, kY, kZ}, {1, 1, 0}},
                                              {{-kX, -kY, kZ}, {1, -1, 0}}};
  static const auto with = [](std::vector<Place> motors, const std::vector<Place>& more) {
    motors.insert(motors.end(), more.begin(), more.end());
    return motors;
  };
  static const std::vector<Place> simple = {{{0, kY, 0}, {1, 0, 0}}, {{0, -kY, 0}, {1, 0, 0}}};
  static const std::vector<Place> simple4 =
      with(simple, {{{0, kY, 0}, {0, 0, 1}}, {{0, -kY, 0}, {0, 0, 1}}});
  static const std::vector<Frame> all = {
      {"vectored", with(vectored, {{{0, kY, 0}, {0, 0, 1}}, {{0, -kY, 0}, {0, 0, 1}}})},
      {"vectored_6dof", with(vectored, {{{kVerticalX, 1, 0}, {0, 0, 1}},
                                        {{kVerticalX, -1, 0}, {0, 0, 1}},
                                        {{-kVerticalX, 1, 0}, {0, 0, 1}},
                                        {{-kVerticalX, -1, 0}, {0, 0, 1}}})},
      {"vectored_6dof_90deg",
       {{{kX, -kY, 0}, {0, 0, -1}},
        {{0, -kY, 0}, {1, 0, 0}},
        {{-kX, -kY, 0}, {0, 0, -1}},
        {{kX, 0, 0}, {0, 1, 0}},
        {{-kX, 0, 0}, {0, 1, 0}},
        {{kX, kY, 0}, {0, 0, -1}},
        {{0, kY, 0}, {1, 0, 0}},
        {{-kX, kY, 0}, {0, 0, -1}}}},
      {"bluerov1",
       {{{0, kY, 0}, {1, 0, 0}},
        {{0, -kY, 0}, {1, 0, 0}},
        {{kX, kY, 0}, {0, 0, -1}},
        {{kX, -kY, 0}, {0, 0, -1}},
        {{-kX, 0, 0}, {0, 0, -1}},
        {{0, 0, kZ}, {0, 1, 0}}}},
      {"simplerov_3", with(simple, {{{0, 0, 0}, {0, 0, 1}}})},
      {"simplerov_4", simple4},
      {"simplerov_5", with(simple4, {{{0, 0, 0}, {0, 1, 0}}})}};
  return all;
}

// A sum of squares of two lengths over the same of the Heavy.
double squares(const Eigen::Vector3d& size, int a, int b) {
  return (size(a) * size(a) + size(b) * size(b)) /
         (kHeavySize(a) * kHeavySize(a) + kHeavySize(b) * kHeavySize(b));
}

}  // namespace

std::vector<std::string> frame_names() {
  std::vector<std::string> names;
  std::ranges::transform(frames(), std::back_inserter(names), &Frame::name);
  return names;
}

std::vector<Thruster> frame_thrusters(const std::string& frame, const Eigen::Vector3d& size_m) {
  const Frame& found = frames()[require_name({}, frame, "frame of ArduSub", frame_names())];
  std::vector<Thruster> thrusters;
  for (const Place& motor : found.motors) {
    Thruster thruster;
    thruster.name = "m" + std::to_string(thrusters.size() + 1);
    thruster.position_m = 0.5 * size_m.cwiseProduct(Eigen::Vector3d(motor.place.data()));
    thruster.direction = Eigen::Vector3d(motor.direction.data()).normalized();
    thruster.max_speed_rps = 1.0;
    thrusters.push_back(thruster);
  }
  return thrusters;
}

int wrench_rank(const std::vector<Thruster>& thrusters) {
  return static_cast<int>(rank_of(thrust_axes(thrusters)));
}

std::array<AxisDrive, 6> driven_axes(const std::vector<Thruster>& thrusters) {
  constexpr double kNegligible = 1e-9;  // of a unit wrench, rounding
  const Eigen::MatrixXd axes = thrust_axes(thrusters);
  const Eigen::MatrixXd range = axes * pseudo_inverse(axes);
  std::array<AxisDrive, 6> driven{};
  for (Eigen::Index axis = 0; axis < 6; ++axis) {
    const bool is_pushed = axes.row(axis).cwiseAbs().maxCoeff() > kNegligible;
    const bool is_alone = (range.col(axis) - Vector6::Unit(axis)).norm() < kNegligible;
    driven.at(static_cast<std::size_t>(axis)) = is_alone    ? AxisDrive::alone
                                                : is_pushed ? AxisDrive::together
                                                            : AxisDrive::none;
  }
  return driven;
}

VehicleParameters similar_vehicle(double mass_kg, const Eigen::Vector3d& size_m) {
  const double mass = mass_kg / kHeavyMass;
  const Eigen::Vector3d stretch = size_m.cwiseQuotient(kHeavySize);
  const Eigen::Vector3d inertia(mass * squares(size_m, 1, 2), mass * squares(size_m, 0, 2),
                                mass * squares(size_m, 0, 1));
  const Eigen::Vector3d area(stretch(1) * stretch(2), stretch(0) * stretch(2),
                             stretch(0) * stretch(1));
  // ∫ |r|³ dA of the face that moves most: roll and pitch move the top, yaw the side.
  const Eigen::Vector3d turning(area(2) * std::pow(stretch(1), 3),
                                area(2) * std::pow(stretch(0), 3),
                                area(1) * std::pow(stretch(0), 3));
  VehicleParameters vehicle;
  vehicle.mass_kg = mass_kg;
  vehicle.inertia_kg_m2 = Eigen::Vector3d(0.26, 0.23, 0.37).cwiseProduct(inertia).asDiagonal();
  vehicle.centre_of_buoyancy_m.z() = -0.01 * stretch(2);
  vehicle.net_buoyancy_n = 2.44 * mass;
  const Vector6 added = (Vector6() << mass * Eigen::Vector3d(6.36, 7.12, 18.68),
                         Eigen::Vector3d(0.189, 0.135, 0.222).cwiseProduct(inertia))
                            .finished();
  vehicle.added_mass = added.asDiagonal();
  vehicle.linear_damping << Eigen::Vector3d(13.7, 0.0, 33.0).cwiseProduct(area),
      Eigen::Vector3d(0.0, 0.8, 0.0).cwiseProduct(turning);
  vehicle.quadratic_damping << Eigen::Vector3d(141.0, 217.0, 190.0).cwiseProduct(area),
      Eigen::Vector3d(1.19, 0.47, 1.5).cwiseProduct(turning);
  vehicle.command_unit = CommandUnit::pwm;
  vehicle.rotor_lag_s = 0.08;
  vehicle.rotor_delay_s = 0.02;
  vehicle.hold = {.depth_p = 60.0 * mass,
                  .depth_i = mass,
                  .depth_d = 80.0 * mass,
                  .pitch_p = 8.0 * inertia(1),
                  .pitch_d = 3.0 * inertia(1),
                  .roll_p = 8.0 * inertia(0),
                  .roll_d = 3.0 * inertia(0)};
  return vehicle;
}

}  // namespace kelpie::simulator
