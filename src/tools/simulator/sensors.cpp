// SPDX-License-Identifier: Apache-2.0
#include "simulator/sensors.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::simulator {

SensorNoise noise_preset(const std::string& name) {
  static const std::map<std::string, SensorNoise> presets = {{"none", {}},
                                                             {"as_recorded",
                                                              {.least_white_m_s = 0.0005,
                                                               .greatest_white_m_s = 0.0005,
                                                               .yaw_white_rad_s = 0.00036,
                                                               .attitude_white_rad = 0.001}},
                                                             {"raw_dvl",
                                                              {.scale = 0.002,
                                                               .bias_m_s = 0.001,
                                                               .least_white_m_s = 0.002,
                                                               .greatest_white_m_s = 0.005,
                                                               .yaw_white_rad_s = 0.00036,
                                                               .attitude_white_rad = 0.001}},
                                                             // As recorded, 52 times over.
                                                             {"stress",
                                                              {.least_white_m_s = 0.026,
                                                               .greatest_white_m_s = 0.026,
                                                               .yaw_white_rad_s = 0.0187,
                                                               .attitude_white_rad = 0.052}}};
  if (const auto preset = presets.find(name); preset != presets.end()) {
    return preset->second;
  }
  std::vector<std::string> names;
  std::transform(presets.begin(), presets.end(), std::back_inserter(names),
                 [](const auto& preset) { return preset.first; });
  throw InputError(unknown_name(name, "noise preset", names));
}

VelocitySensors::VelocitySensors(const SensorNoise& noise, std::uint64_t seed)
    : stream_(seed, "sensors") {
  const auto draw = [this](double low, double high) { return stream_.uniform(low, high); };
  for (const Eigen::Index axis : {0, 1}) {
    factor_(axis) = 1.0 + draw(-noise.scale, noise.scale);
    bias_(axis) = draw(-noise.bias_m_s, noise.bias_m_s);
    white_(axis) = draw(noise.least_white_m_s, noise.greatest_white_m_s);
  }
  factor_(2) = 1.0;
  bias_(2) = 0.0;
  white_(2) = noise.yaw_white_rad_s;
}

Eigen::Vector3d VelocitySensors::measure(const Eigen::Vector3d& velocity) {
  // Drawn one by one: the order of evaluation of a constructor's arguments is the compiler's.
  Eigen::Vector3d white;
  for (double& value : white) {
    value = stream_.normal();
  }
  const Eigen::Vector3d healthy =
      factor_.cwiseProduct(velocity) + bias_ + white_.cwiseProduct(white);
  const Eigen::Vector3d shown = fault_.scale.cwiseProduct(healthy) + fault_.bias;
  shown_ = (fault_.frozen.array() > 0.0).select(shown_, shown);
  return shown_;
}

SixAxisSensors::SixAxisSensors(const SensorNoise& noise, std::uint64_t seed)
    : stream_(seed, "sensors of six axes"),
      rate_white_(noise.yaw_white_rad_s),
      attitude_white_(noise.attitude_white_rad) {
  for (const Eigen::Index axis : {0, 1, 2}) {
    factor_(axis) = 1.0 + stream_.uniform(-noise.scale, noise.scale);
    bias_(axis) = stream_.uniform(-noise.bias_m_s, noise.bias_m_s);
    white_(axis) = stream_.uniform(noise.least_white_m_s, noise.greatest_white_m_s);
  }
}

Vector6 SixAxisSensors::measure(const Vector6& velocity) {
  Vector6 measured;
  for (Eigen::Index axis = 0; axis < 6; ++axis) {
    const double white = stream_.normal();
    measured(axis) = axis < 3 ? factor_(axis) * velocity(axis) + bias_(axis) + white_(axis) * white
                              : velocity(axis) + rate_white_ * white;
  }
  return measured;
}

Eigen::Vector3d SixAxisSensors::measure_attitude(const Eigen::Vector3d& angles_rad) {
  Eigen::Vector3d measured = angles_rad;
  for (double& angle : measured) {
    angle += attitude_white_ * stream_.normal();
  }
  return measured;
}

template <int axes>
Eigen::Matrix<double, axes, 1> smoothed_slope(
    std::span<const Eigen::Matrix<double, axes, 1>> measurements, std::size_t at, std::size_t half,
    double period_s) {
  using Measurement = Eigen::Matrix<double, axes, 1>;
  const std::size_t first = at - std::min(at, half);
  const std::size_t last = std::min(measurements.size() - 1, at + half);
  const double middle = 0.5 * static_cast<double>(first + last);
  Measurement weighted = Measurement::Zero();
  double squares = 0.0;
  for (std::size_t i = first; i <= last; ++i) {
    const double offset_s = (static_cast<double>(i) - middle) * period_s;
    weighted += offset_s * measurements[i];
    squares += offset_s * offset_s;
  }
  return weighted / squares;
}

template Eigen::Vector3d smoothed_slope<3>(std::span<const Eigen::Vector3d>, std::size_t,
                                           std::size_t, double);
template Vector6 smoothed_slope<6>(std::span<const Vector6>, std::size_t, std::size_t, double);

}  // namespace kelpie::simulator
