// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace kelpie::testing {

/// A vehicle that surges, sways and turns under three forces; what it does at step k is the same
/// for everybody who asks.
class Swimming {
 public:
  static constexpr double kStepS = 0.02;
  static constexpr std::int32_t kBeginSec = 1'700'000'000;

  /// Goes on by one step.
  void step() {
    const double t = kStepS * static_cast<double>(steps_);
    force = {8.0 * std::sin(0.7 * t) + 4.0 * std::sin(1.9 * t),
             6.0 * std::sin(0.9 * t + 1.0) + 3.0 * std::sin(2.3 * t),
             5.0 * std::sin(1.1 * t + 2.0) + 2.0 * std::sin(1.7 * t)};
    for (std::size_t i = 0; i < velocity.size(); ++i) {
      acceleration[i] = 0.08 * force[i] - 0.8 * velocity[i] * std::abs(velocity[i]);
      velocity[i] += kStepS * acceleration[i];
    }
    ++steps_;
  }
  std::int32_t sec() const { return kBeginSec + static_cast<std::int32_t>((steps_ - 1) / 50); }
  std::uint32_t nanosec() const {
    return static_cast<std::uint32_t>((steps_ - 1) % 50) * 20'000'000U;
  }

  std::array<double, 3> force{};     // along x and y, about z
  std::array<double, 3> velocity{};  // the same, behind the step
  std::array<double, 3> acceleration{};

 private:
  std::int64_t steps_ = 0;
};

}  // namespace kelpie::testing
