// SPDX-License-Identifier: Apache-2.0
// 03: a controller that follows a speed with a learned model. At every step it linearises the
// model at the vehicle's state and solves for the commands that give the wanted acceleration,
//
//     f(x) + ∂f/∂n δn = a_wanted,
//
// while the model keeps learning. One prediction with its Jacobian per step, without allocation.
//
// Prints:
//   speed followed to 0.0032 m/s (root mean square), yaw rate at the end -0.000 rad/s

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "kelpie/model/dynamics_model.hpp"
#include "toy_vehicle.hpp"

namespace {

constexpr double kMostRevolutions = 9.0;  // rev/s

using Commands = std::array<double, 2>;

kelpie::DynamicsModel learned_from_a_pilot(ToyVehicle& vehicle) {
  kelpie::ModelSettings settings = kelpie::ModelSettings::from_preset("default", 2);
  settings.assign("buffer", "300");
  settings.assign("fine", "0");  // smoother derivatives: docs/controller.md
  kelpie::DynamicsModel model({"u", "r", "n1", "n2"}, {"udot", "rdot"}, settings);
  for (int i = 0; i < 2000; ++i) {
    const auto [n1, n2] = ToyVehicle::pilot(vehicle.t());
    const std::array<double, 4> x = vehicle.inputs(n1, n2);
    model.update(x, vehicle.measure(x), vehicle.t());
    vehicle.drive(n1, n2);
  }
  return model;
}

Commands next_commands(const kelpie::DynamicsModel& model, const std::array<double, 4>& x,
                       const Eigen::Vector2d& wanted) {
  constexpr double kDamping = 1e-4;  // a thruster at rest has derivative 0
  std::array<double, 2> y;
  std::array<double, 8> jacobian;
  model.predict_with_jacobian(x, y, jacobian);
  Eigen::Matrix2d by_commands;
  by_commands << jacobian[2], jacobian[3], jacobian[6], jacobian[7];
  const Eigen::Vector2d missing = wanted - Eigen::Vector2d(y[0], y[1]);
  const Eigen::Matrix2d normal =
      by_commands.transpose() * by_commands + kDamping * Eigen::Matrix2d::Identity();
  const Eigen::Vector2d change = normal.ldlt().solve(by_commands.transpose() * missing);
  return {std::clamp(x[2] + change[0], -kMostRevolutions, kMostRevolutions),
          std::clamp(x[3] + change[1], -kMostRevolutions, kMostRevolutions)};
}

}  // namespace

int main() {
  ToyVehicle vehicle;
  kelpie::DynamicsModel model = learned_from_a_pilot(vehicle);

  Commands n{5.0, 5.0};
  double squares = 0.0;
  int judged = 0;
  for (int i = 0; i < 600; ++i) {
    const double phase = 0.2 * ToyVehicle::kStepS * i;
    const double speed = 0.6 + 0.2 * std::sin(phase);  // the speed to follow, without turning
    const double acceleration = 0.2 * 0.2 * std::cos(phase);
    const Eigen::Vector2d wanted(acceleration + 1.0 * (speed - vehicle.u()), -1.0 * vehicle.r());
    n = next_commands(model, vehicle.inputs(n[0], n[1]), wanted);
    const std::array<double, 4> x = vehicle.inputs(n[0], n[1]);
    model.update(x, vehicle.measure(x), vehicle.t());
    vehicle.drive(n[0], n[1]);
    if (i >= 100) {  // by then it has caught up
      squares += (speed - vehicle.u()) * (speed - vehicle.u());
      ++judged;
    }
  }
  std::printf("speed followed to %.4f m/s (root mean square), yaw rate at the end %.3f rad/s\n",
              std::sqrt(squares / judged), vehicle.r());
}
