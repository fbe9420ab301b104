// SPDX-License-Identifier: Apache-2.0
// A vehicle that lies still for a minute and then sets off slowly: the scale of sensor noise is
// thousands of times too small for what comes.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kelpie/core/random.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/vehicle/diagnosis.hpp"

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

// A boat with a propeller and a rudder, whose lags the model isn't told: errors go together for
// seconds, those at rest do not.
class Boat {
 public:
  explicit Boat(std::uint64_t seed) : random_(seed, "boat") {}

  void step(double t, double rest_s) {
    if (t >= rest_s && t >= next_s_) {
      next_s_ = t + random_.uniform(8.0, 20.0);
      rpm_ = random_.uniform(300.0, 1500.0);
      rudder_ = random_.uniform(-0.44, 0.44);
    }
    constexpr double kPart = 0.02;
    for (double part = 0.0; part < kBoatStepS - 0.5 * kPart; part += kPart) {
      turning_ += kPart / 0.4 * (rpm_ - turning_);
      angle_ += kPart * std::clamp((rudder_ - angle_) / 0.3, -0.35, 0.35);
      const auto [u, v, r] = nu_;
      const double flow = u * u + 3.6e-7 * turning_ * turning_;
      const double side = 1260.0 * flow * angle_;
      y = {(2e-4 * turning_ * std::abs(turning_) - 25.0 * u - 38.0 * u * std::abs(u)) / 220.0 +
               1.36 * v * r,
           (side - 180.0 * v - 180.0 * v * std::abs(v) - 20.0 * r) / 300.0 - 0.73 * u * r,
           (-1.1 * side - 70.0 * r - 80.0 * r * std::abs(r) - 8.0 * v) / 160.0 - 0.5 * u * v};
      for (std::size_t i = 0; i < 3; ++i) {
        nu_[i] += kPart * y[i];
      }
    }
    for (std::size_t i = 0; i < 3; ++i) {
      x[i] = nu_[i] + 5e-3 * random_.normal();
      y[i] += 5e-3 * random_.normal();
    }
    x[3] = rpm_;
    x[4] = rudder_;
  }

  static constexpr double kBoatStepS = 0.2;
  std::array<double, 5> x{};
  std::array<double, 3> y{};

 private:
  RandomStream random_;
  std::array<double, 3> nu_{};
  double next_s_ = 0.0, rpm_ = 0.0, rudder_ = 0.0, turning_ = 0.0, angle_ = 0.0;
};

// By seed.
class Rest : public ::testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Seed, Rest, ::testing::Values(1));
INSTANTIATE_TEST_SUITE_P(Measured, Rest, ::testing::Values(2, 3));

TEST_P(Rest, MinutesAtRestAreNoVehicleThatAnotherIsComparedWith) {
  constexpr double kLongRestS = 300.0;
  Boat boat(GetParam());
  DynamicsModel model({"u", "v", "r", "rpm", "rudder"}, {"udot", "vdot", "rdot"},
                      ModelSettings::from_preset("default", 3));
  for (double t = 0.0; t < kLongRestS + 400.0; t += Boat::kBoatStepS) {
    boat.step(t, kLongRestS);
    model.update(boat.x, boat.y, t);
    ASSERT_TRUE(std::ranges::none_of(model.decisions(), &Decision::changed)) << t;
  }
  EXPECT_TRUE(model.findings().empty());
}

TEST_P(Rest, SettingOffSlowlyNothingOverflowsAndAMinuteLaterItCostsNothing) {
  Vehicle vehicle(GetParam());
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
  EXPECT_GT(1.0 - residual / total, 0.93);
}

// A vehicle that moves for ten seconds of every hundred, from the first sample on.
double r2_of_short_moves(std::uint64_t seed) {
  RandomStream random(seed, "short moves");
  DynamicsModel model({"u", "thr"}, {"udot"}, ModelSettings::from_preset("default", 1));
  double u = 0.0;
  double push = 0.0;
  double size = 0.0;
  double residual = 0.0;
  double total = 0.0;
  for (int i = 0; i < 2400; ++i) {
    const int phase = i % 200;
    size = phase == 0 ? random.uniform(0.5, 1.0) * (random.normal() < 0.0 ? -1.0 : 1.0) : size;
    const double moving = phase >= 20 ? 0.0 : phase < 10 ? size : -size;
    const double command = moving + 0.01 * random.normal();
    push = 0.9 * push + 0.002 * random.normal();
    const double target = 0.2 * command - 0.3 * u - 0.2 * u * std::abs(u) + push;
    const std::array x{u + 0.002 * random.normal(), command};
    const std::array y{target + 0.002 * random.normal()};
    u += 0.5 * target;
    model.update(x, y, 0.5 * i);
    if (i >= 600) {
      residual += std::pow(model.decisions()[0].prediction.value - y[0], 2);
      total += y[0] * y[0];
    }
  }
  return 1.0 - residual / total;
}

TEST_P(Rest, AScaleOfMovementIsKeptThroughRest) {
  EXPECT_GT(r2_of_short_moves(GetParam()), 0.95);  // 0.6 to 0.8 with a scale of rest
}

}  // namespace
}  // namespace kelpie::rest_test
