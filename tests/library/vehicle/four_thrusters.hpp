// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "kelpie/core/random.hpp"
#include "kelpie/vehicle/diagnosis.hpp"

namespace kelpie::testing {

/// Surge, sway and yaw with four thrusters, thrust n|n|: two at the stern, two across.
class FourThrusters {
 public:
  explicit FourThrusters(std::uint64_t seed) : random_(seed, "vehicle") {}

  static Diagnosis diagnosis() { return {7, {0, 1, 2}, {0, 1, 5}}; }
  static std::vector<CommandRange> ranges() {
    return {{3, -4.0, 4.0}, {4, -4.0, 4.0}, {5, -4.0, 4.0}, {6, -4.0, 4.0}};
  }
  inline static const std::vector<std::string> kInputs{"u", "v", "r", "th1", "th2", "th3", "th4"};
  inline static const std::vector<std::string> kTargets{"udot", "vdot", "rdot"};

  static constexpr std::array<std::array<double, 4>, 3> kThrust{
      {{0.02, 0.02, 0.0, 0.0}, {0.0, 0.0, 0.03, 0.03}, {-0.02, 0.02, 0.02, -0.02}}};
  static constexpr std::array<double, 3> kDrag{0.8, 1.2, 1.0};

  /// For so many seconds at 4 Hz.
  void drive(Diagnosis& diagnosis, double seconds) {
    for (int k = 0; k < static_cast<int>(4.0 * seconds); ++k) {
      std::array<double, 7> x{nu_[0], nu_[1], nu_[2]};
      for (std::size_t j = 0; j < 4; ++j) {
        phase_[j] += 0.25 * (0.2 + 0.13 * static_cast<double>(j) + 0.1 * random_.uniform(0.0, 1.0));
        x[3 + j] = effort * std::sin(phase_[j]);
      }
      std::array<double, 3> y{};
      for (std::size_t i = 0; i < 3; ++i) {
        y[i] = -0.2 * nu_[i] - kDrag[i] * nu_[i] * std::abs(nu_[i]);
        for (std::size_t j = 0; j < 4; ++j) {
          y[i] += share[j] * kThrust[i][j] * x[3 + j] * std::abs(x[3 + j]);
        }
      }
      y[0] += push_m_s2 * std::cos(heading_);
      y[1] -= push_m_s2 * std::sin(heading_);
      heading_ += 0.25 * nu_[2];
      for (std::size_t i = 0; i < 3; ++i) {
        nu_[i] += 0.25 * y[i];
        y[i] += 0.01 * random_.normal();
      }
      diagnosis.update(x, y, t);
      t += 0.25;
    }
  }

  /// The greatest acceleration with commands up to 4.
  double attainable(std::size_t axis) const {
    double sum = 0.0;
    for (std::size_t j = 0; j < 4; ++j) {
      sum += 16.0 * share[j] * std::abs(kThrust[axis][j]);
    }
    return sum;
  }

  std::array<double, 4> share{1.0, 1.0, 1.0, 1.0};
  double effort = 4.0;     ///< amplitude of the commands
  double push_m_s2 = 0.0;  ///< of the water, in a direction of the world
  double t = 0.0;

 private:
  RandomStream random_;
  std::array<double, 3> nu_{};
  std::array<double, 4> phase_{};
  double heading_ = 0.0;
};

}  // namespace kelpie::testing
