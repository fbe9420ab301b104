// SPDX-License-Identifier: Apache-2.0
// The first minute of an unknown vehicle with little noise, whose equations are linear in the
// terms.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <string_view>

#include "kelpie/core/random.hpp"
#include "kelpie/model/dynamics_model.hpp"

namespace kelpie::first_minute_test {
namespace {

constexpr double kStepS = 0.2;

// Three velocities, three thrusters; commands are steps of one to four seconds.
class Vehicle {
 public:
  explicit Vehicle(std::uint64_t seed) : random_(seed, "first minute") {
    std::ranges::generate(factors_, [&] { return random_.uniform(0.7, 1.3); });
  }

  void step(double t) {
    if (t >= next_s_) {
      next_s_ = t + random_.uniform(1.0, 4.0);
      std::ranges::generate(std::span(x).last(3), [&] { return random_.uniform(-1.0, 1.0); });
    }
    for (int part = 0; part < 10; ++part) {
      y = accelerations();
      for (std::size_t i = 0; i < 3; ++i) {
        x[i] += 0.1 * kStepS * y[i];
      }
    }
    y = accelerations();
  }

  std::array<double, 6> x{};
  std::array<double, 3> y{};

 private:
  std::array<double, 3> accelerations() const {
    const auto [u, v, r, n1, n2, n3] = x;
    const auto [a, b, c, d, e, f] = factors_;
    return {
        a * (n1 + n2) - d * (0.5 * u + 1.5 * u * std::abs(u)) + 1.4 * v * r,
        b * 0.7 * n3 - e * (0.4 * v + 1.3 * v * std::abs(v)) - 0.7 * u * r,
        c * (0.4 * (n1 - n2) + 0.15 * n3) - f * (0.5 * r + 1.8 * r * std::abs(r)) - 0.4 * u * v};
  }

  RandomStream random_;
  std::array<double, 6> factors_{};
  double next_s_ = 0.0;
};

// The mean R² of three axes and some vehicles on other drives of 300 s, after so many seconds.
double mean_r_squared_after(double seconds, std::uint64_t vehicles) {
  const ModelSettings settings = ModelSettings::from_preset("default", 3);
  double sum = 0.0;
  for (std::uint64_t seed = 0; seed < vehicles; ++seed) {
    Vehicle vehicle(seed);
    RandomStream noise(seed, "noise");
    DynamicsModel model({"u", "v", "r", "n1", "n2", "n3"}, {"udot", "vdot", "rdot"}, settings);
    for (double t = 0.0; t < seconds; t += kStepS) {
      vehicle.step(t);
      std::array<double, 3> y = vehicle.y;
      for (double& value : y) {
        value += 0.02 * noise.normal();
      }
      model.update(vehicle.x, y, t);
    }
    std::array<double, 3> errors{};
    std::array<double, 3> squares{};
    for (double t = seconds; t < seconds + 300.0; t += kStepS) {
      vehicle.step(t);
      std::array<double, 3> said{};
      model.predict(vehicle.x, said);
      for (std::size_t k = 0; k < 3; ++k) {
        errors[k] += (said[k] - vehicle.y[k]) * (said[k] - vehicle.y[k]);
        squares[k] += vehicle.y[k] * vehicle.y[k];
      }
    }
    for (std::size_t k = 0; k < 3; ++k) {
      sum += 1.0 - errors[k] / squares[k];
    }
  }
  return sum / (3.0 * static_cast<double>(vehicles));
}

TEST(FirstMinute, AVehicleLinearInItsTermsIsKnown) {
  EXPECT_GT(mean_r_squared_after(60.0, 1), 0.97);
}

TEST(MeasuredFirstMinute, SixVehiclesLinearInTheirTermsAreKnown) {
  EXPECT_GT(mean_r_squared_after(30.0, 6), 0.88);
  EXPECT_GT(mean_r_squared_after(60.0, 6), 0.988);
}

}  // namespace
}  // namespace kelpie::first_minute_test
