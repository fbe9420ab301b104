// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>

#include "kelpie/core/random.hpp"
#include "kelpie/vehicle/diagnosis.hpp"

namespace kelpie::testing {

/// A vehicle with surge, sway, yaw and three thrusters, integrated in small steps and measured four
/// times a second with a little noise.
class Drive {
 public:
  using Row = std::array<double, 6>;  // u, v, r, n1, n2, n3
  using Accelerations = std::array<double, 3>;

  /// What has become of it.
  struct Fault {
    std::array<double, 3> thrust{1.0, 1.0, 1.0};
    double drag = 1.0;      ///< in sway
    double inertia = 1.0;   ///< in surge and sway
    double force = 0.0;     ///< on surge
    double scale = 1.0;     ///< of r
    double bias = 0.0;      ///< of u
    bool frozen = false;    ///< v
    bool together = false;  ///< thrusters 1 and 3 are one and the same to the vehicle
    std::function<double(double)> strange{};  ///< on sway, over time
  };

  explicit Drive(std::uint64_t seed) : random_(seed, "drive") {
    for (double& rate : rates_) {
      rate = random_.uniform(0.1, 0.3);
    }
  }

  /// Shows so many rows to `update(x, y, t)`.
  template <typename Update>
  void show(std::size_t rows, const Fault& fault, Update update) {
    for (std::size_t i = 0; i < rows; ++i) {
      constexpr int kFine = 10;
      for (int fine = 0; fine < kFine; ++fine) {
        t_ += 0.25 / kFine;
        turn(fault);
        const Accelerations a = accelerations(fault);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          now_[axis] += a[axis] * 0.25 / kFine;
        }
      }
      Row x = now_;
      Accelerations y = accelerations(fault);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        x[axis] += 2e-4 * random_.normal();
        y[axis] += 1e-3 * random_.normal();
      }
      x[0] += fault.bias;
      x[2] *= fault.scale;
      y[2] *= fault.scale;
      if (fault.frozen) {
        x[1] = shown_v_;
        y[1] = 0.0;
      }
      shown_v_ = x[1];
      update(x, y, t_);
    }
  }
  void show(std::size_t rows, const Fault& fault, Diagnosis& diagnosis) {
    show(rows, fault,
         [&](const Row& x, const Accelerations& y, double t) { diagnosis.update(x, y, t); });
  }

  double t() const { return t_; }

 private:
  void turn(const Fault& fault) {
    for (std::size_t i = 0; i < 3; ++i) {
      now_[3 + i] = 6.0 * std::sin(rates_[i] * t_) + 5.0 * std::sin(rates_[i + 3] * t_ + 1.0);
    }
    if (fault.together) {
      now_[5] = now_[3];
    }
  }

  Accelerations accelerations(const Fault& fault) const {
    const auto thrust = [&](std::size_t i) {
      return fault.thrust[i] * now_[3 + i] * std::abs(now_[3 + i]);
    };
    const auto drag = [](double v, double linear, double square) {
      return linear * v + square * v * std::abs(v);
    };
    const auto [u, v, r] = std::array{now_[0], now_[1], now_[2]};
    const double side = fault.together ? 0.0 : 1.0;
    const double ahead = fault.together ? 1.0 : 0.0;
    const double du = 3e-3 * (thrust(0) + thrust(1) + ahead * thrust(2)) - drag(u, 0.2, 0.3) +
                      0.2 * v * r + fault.force;
    double dv = 3e-3 * side * thrust(2) - fault.drag * drag(v, 0.3, 0.8) - 0.2 * u * r;
    const double dr = 5e-3 * (thrust(1) - thrust(0) - ahead * thrust(2)) - drag(r, 0.3, 0.5) +
                      2e-3 * side * thrust(2);
    if (fault.strange) {
      dv += fault.strange(t_);
    }
    return {du / fault.inertia + v * r, dv / fault.inertia - u * r, dr};
  }

  RandomStream random_;
  std::array<double, 6> rates_{};
  Row now_{};
  double t_ = 0.0;
  double shown_v_ = 0.0;
};

inline Diagnosis drive_diagnosis() {
  return Diagnosis(6, {0, 1, 2}, {0, 1, 5});
}

}  // namespace kelpie::testing
