// SPDX-License-Identifier: Apache-2.0
// 10: a vehicle that follows a speed and a heading rate, and whose starboard thruster loses half
// its force halfway. A PI controller alone, and the same with the model that is learned while it
// drives: the model is inverted for the commands, what it misses at present is added, and where it
// doesn't know its way the controller goes on alone.
//
// Prints:
//   PI alone:        before 0.0545 m/s, after 0.0720 m/s off (root mean square)
//   with the model:  before 0.0018 m/s, after 0.0126 m/s off (root mean square)

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "kelpie/model/dynamics_model.hpp"
#include "toy_vehicle.hpp"

namespace {

constexpr double kMost = 12.0;  // rev/s

// Commands by the nominal thrust 0.01 n|n|.
std::array<double, 2> nominal_commands(const Eigen::Vector2d& a) {
  const auto speed = [](double thrust) {
    return std::clamp(std::copysign(std::sqrt(std::abs(thrust) / 0.01), thrust), -kMost, kMost);
  };
  return {speed(0.5 * (a.x() + a.y())), speed(0.5 * (a.x() - a.y()))};
}

// A few damped Gauss-Newton steps to f(x) + d = a; from `n` on.
std::array<double, 2> model_commands(const kelpie::DynamicsModel& model, std::array<double, 4> x,
                                     const Eigen::Vector2d& a, bool& known) {
  std::array<kelpie::Prediction, 2> said;
  std::array<double, 2> y;
  std::array<double, 8> slope;
  model.predict(x, said, 0.2);
  for (int step = 0; step < 4; ++step) {
    model.predict_with_jacobian(x, y, slope);
    Eigen::Matrix2d by_n;
    by_n << slope[2], slope[3], slope[6], slope[7];
    const Eigen::Vector2d missing =
        a - Eigen::Vector2d(y[0] + said[0].disturbance, y[1] + said[1].disturbance);
    const Eigen::Matrix2d normal = by_n.transpose() * by_n + 1e-4 * Eigen::Matrix2d::Identity();
    const Eigen::Vector2d change = normal.ldlt().solve(by_n.transpose() * missing);
    x[2] = std::clamp(x[2] + std::clamp(change[0], -2.0, 2.0), -kMost, kMost);
    x[3] = std::clamp(x[3] + std::clamp(change[1], -2.0, 2.0), -kMost, kMost);
  }
  model.predict(x, said, 0.2);
  known = said[0].novelty < 0.98 && said[1].novelty < 0.98 && said[0].upper - said[0].lower < 0.5;
  return {x[2], x[3]};
}

std::array<double, 2> follow(bool with_model) {
  kelpie::ModelSettings settings = kelpie::ModelSettings::from_preset("default", 2);
  settings.assign("buffer", "200");
  settings.assign("fine", "0");  // smoother derivatives: docs/howto/controller.md
  kelpie::DynamicsModel model({"u", "r", "n1", "n2"}, {"udot", "rdot"}, settings);
  ToyVehicle vehicle;
  Eigen::Vector2d sum(0.0, 0.0);
  std::array<double, 2> squares{};
  for (int i = 0; i < 3000; ++i) {
    const bool damaged = i >= 2000;
    const double phase = 0.25 * vehicle.t();
    const Eigen::Vector2d reference(0.5 + 0.2 * std::sin(phase), 0.2 * std::cos(0.7 * phase));
    const Eigen::Vector2d rate(0.05 * std::cos(phase), -0.035 * std::sin(0.7 * phase));
    const Eigen::Vector2d off = reference - Eigen::Vector2d(vehicle.u(), vehicle.r());
    sum += 0.3 * off * ToyVehicle::kStepS;
    std::array<double, 2> n = nominal_commands(1.5 * off + sum);
    if (i < 600) {
      n = ToyVehicle::pilot(vehicle.t());  // somebody tries it first
      sum.setZero();
    } else if (with_model && model.ready()) {
      bool known = false;
      const std::array<double, 2> learned =
          model_commands(model, vehicle.inputs(n[0], n[1]), rate + 1.5 * off + sum, known);
      n = known ? learned : n;
    }
    const double starboard = ToyVehicle::weakened(n[1], damaged ? 0.5 : 1.0);
    const std::array<double, 4> driven = vehicle.inputs(n[0], starboard);
    model.update(vehicle.inputs(n[0], n[1]), vehicle.measure(driven), vehicle.t());
    vehicle.drive(n[0], starboard);
    if (i >= 1000) {
      squares[damaged ? 1 : 0] += off.x() * off.x() / 1000.0;
    }
  }
  return {std::sqrt(squares[0]), std::sqrt(squares[1])};
}

}  // namespace

int main() {
  for (const bool with_model : {false, true}) {
    const auto [before, after] = follow(with_model);
    std::printf("%s before %.4f m/s, after %.4f m/s off (root mean square)\n",
                with_model ? "with the model: " : "PI alone:       ", before, after);
  }
}
