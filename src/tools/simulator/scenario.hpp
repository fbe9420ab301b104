// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "simulator/excitation.hpp"
#include "simulator/parameters.hpp"
#include "simulator/sensors.hpp"

namespace kelpie::simulator {

/// One part of a drive.
struct Phase {
  std::size_t configuration = 0;  ///< index into Scenario::configurations
  double duration_s = 0.0;
  double amplitude = 1.0;  ///< of the excitation, as a share of the greatest speeds, in [0, 1]
  double ramp_s = 0.0;     ///< duration of the change from the configuration before
};

/// Columns of the log.
enum class LogKind {
  planar,  ///< surge, sway, yaw in FLU, speeds of the lateral rotors
  six,     ///< six axes in FRD with attitude, commands of all thrusters, voltage
};

LogKind log_kind_from(const std::string& name);  ///< "planar" or "six_axes"; throws InputError.

/// A vehicle, its configurations over time, its commands and its recording.
struct Scenario {
  VehicleParameters vehicle;
  std::uint64_t seed = 1;
  double rate_hz = 1.0;  ///< rows per second
  LogKind log = LogKind::planar;
  SensorNoise noise;
  Eigen::Vector3d current_m_s = Eigen::Vector3d::Zero();  ///< velocity of the water, NED
  ExcitationSettings excitation;
  std::vector<Configuration> configurations;
  std::vector<Phase> phases;  ///< in order, without a stop between

  /// Throws InputError whose field is the key in a scenario file ("phases[1].duration_s").
  void validate() const;
  double duration_s() const;
};

}  // namespace kelpie::simulator
