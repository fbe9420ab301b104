// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "kelpie/core/random.hpp"
#include "kelpie/svr/regressor.hpp"
#include "kelpie/svr/settings.hpp"

namespace kelpie::testing {

/// One sample of a scaled stream.
struct Sample {
  std::vector<double> z;
  double y = 0.0;
  double t = 0.0;
};

/// What a vehicle makes of two inputs. There are three vehicles.
inline double respond(int plant, double a, double b) {
  switch (plant) {
    case 0:
      return std::sin(a) + 0.5 * b * std::abs(b);
    case 1:
      return -std::sin(a) + 0.8 * b;
    default:
      return 0.9 * std::cos(1.5 * a) - 0.7 * b;
  }
}

/// A smooth function of two inputs that wander slowly, as a vehicle's do. Targets have about unit
/// variance.
inline std::vector<Sample> wandering_stream(std::uint64_t seed, std::size_t samples,
                                            double noise = 0.02, int plant = 0,
                                            double start_s = 0.0) {
  RandomStream random(seed, "wandering");
  std::vector<Sample> stream;
  double phase_a = random.uniform(0.0, 6.0);
  double phase_b = random.uniform(0.0, 6.0);
  for (std::size_t i = 0; i < samples; ++i) {
    phase_a += random.uniform(0.02, 0.08);
    phase_b += random.uniform(0.03, 0.10);
    const double a = 1.4 * std::sin(phase_a);
    const double b = 1.4 * std::sin(phase_b);
    stream.push_back({{a, b},
                      respond(plant, a, b) + noise * random.normal(),
                      start_s + 0.25 * static_cast<double>(i)});
  }
  return stream;
}

/// Settings that suit these vehicles, without the kernel's other parts.
inline OnlineSvrSettings settings_for_plants() {
  OnlineSvrSettings settings;
  settings.buffer = 300;
  settings.gamma = 0.5;
  settings.epsilon = 0.05;
  settings.c = 10.0;
  settings.fine = 0.0;
  settings.lambda = 0.0;
  return settings;
}

/// R² of a learner on some samples.
inline double r_squared_on(const OnlineRegressor& learner, const std::vector<Sample>& samples) {
  double mean = 0.0;
  for (const Sample& sample : samples) {
    mean += sample.y / static_cast<double>(samples.size());
  }
  double residual = 0.0;
  double total = 0.0;
  for (const Sample& sample : samples) {
    residual += std::pow(learner.predict(sample.z) - sample.y, 2);
    total += std::pow(sample.y - mean, 2);
  }
  return 1.0 - residual / total;
}

}  // namespace kelpie::testing
