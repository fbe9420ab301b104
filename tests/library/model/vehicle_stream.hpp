// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "kelpie/core/random.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "model/model_axis.hpp"

namespace kelpie::testing {

/// A drive of a vehicle with two inputs in raw units of very different size, and two targets.
struct Drive {
  std::vector<std::string> inputs{"speed", "thrust"};
  std::vector<std::string> targets{"surge", "sway"};
  std::vector<std::vector<double>> x;
  std::vector<std::vector<double>> y;
};

inline Drive drive(std::uint64_t seed, std::size_t samples) {
  RandomStream random(seed, "drive");
  Drive drive;
  double phase = 0.0;
  double slow = 1.0;
  for (std::size_t i = 0; i < samples; ++i) {
    phase += random.uniform(0.02, 0.1);
    slow += random.uniform(0.01, 0.05);
    const double speed = 0.4 * std::sin(slow) + 0.1;
    const double thrust = 800.0 * std::sin(phase);
    drive.x.push_back({speed, thrust});
    drive.y.push_back({1e-3 * (thrust * std::abs(thrust) / 800.0 - 900.0 * speed * std::abs(speed)),
                       50.0 + 5.0 * std::sin(4.0 * speed)});
  }
  return drive;
}

/// A number that changes with the units of an axis.
inline double units_of(const DynamicsModel& model) {
  double sum = 0.0;
  for (std::size_t axis = 0; axis < model.axes(); ++axis) {
    const AxisScaling* const scaling = model.mechanisms(axis).scaling();
    sum += scaling != nullptr ? scaling->input.whitening(0, 0) + scaling->input.whitening(1, 1) +
                                    scaling->target.scale
                              : 0.0;
  }
  return sum;
}

}  // namespace kelpie::testing
