// SPDX-License-Identifier: Apache-2.0
// A vehicle that lies still for a minute and then sets off slowly: the scale of sensor noise is
// thousands of times too small for what comes.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "kelpie/core/random.hpp"
#include "kelpie/model/dynamics_model.hpp"

namespace kelpie::rest_test {
namespace {

constexpr double kStepS = 0.25;
constexpr double kRestS = 60.0;
constexpr double kRampS = 30.0;  // until thrusters have their full speed

// Three velocities, three thrusters.
class Vehicle {
 public:
  explicit Vehicle(std::uint64_t seed) : random_(seed, "rest") {}

  void step(double t) {
    const double size = 10.0 * std::clamp((t - kRestS) / kRampS, 0.0, 1.0);
    const std::array n{size * std::sin(0.13 * t), size * std::cos(0.21 * t),
                       size * std::sin(0.34 * t + 1.0)};
    const auto [u, v, r] = nu_;
    y = {0.01 * n[0] * std::abs(n[0]) - u * std::abs(u) - 0.3 * u + v * r,
         0.004 * n[1] * std::abs(n[1]) - 2.0 * v * std::abs(v) - u * r,
         0.02 * n[2] - r - 0.5 * r * std::abs(r)};
    for (std::size_t i = 0; i < 3; ++i) {
      x[i] = nu_[i] + 2e-3 * random_.normal();
      x[3 + i] = n[i] + 1e-3 * random_.normal();
      nu_[i] += kStepS * y[i];
      y[i] += 5e-3 * random_.normal();
    }
  }

  std::array<double, 6> x{};
  std::array<double, 3> y{};

 private:
  RandomStream random_;
  std::array<double, 3> nu_{};
};

TEST(Rest, SettingOffSlowlyNothingOverflowsAndAMinuteLaterItCostsNothing) {
  for (const std::uint64_t seed : {1U, 3U}) {
    Vehicle vehicle(seed);
    DynamicsModel model({"u", "v", "r", "n1", "n2", "n3"}, {"udot", "vdot", "rdot"},
                        ModelSettings::from_preset("default", 3));
    double residual = 0.0;
    double total = 0.0;
    std::array<double, 3> said{};
    for (double t = 0.0; t < kRestS + 250.0; t += kStepS) {
      vehicle.step(t);
      model.update(vehicle.x, vehicle.y, t);
      model.predict(vehicle.x, said);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        ASSERT_TRUE(std::isfinite(said[axis])) << "axis " << axis << " at " << t << " s";
        ASSERT_TRUE(std::isfinite(model.axis(axis).status().kkt_gap));
      }
      if (t > kRestS + kRampS + 60.0) {
        residual += std::pow(model.decisions()[0].prediction.value - vehicle.y[0], 2);
        total += std::pow(vehicle.y[0], 2);
      }
    }
    EXPECT_GT(1.0 - residual / total, 0.93) << "seed " << seed;
  }
}

}  // namespace
}  // namespace kelpie::rest_test
