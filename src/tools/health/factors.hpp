// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "health/episode.hpp"
#include "log/dataset.hpp"

namespace kelpie::health {

/// Columns of the logs of a vehicle with thrusters, rotors or rudders. Indices of inputs, the same
/// in all logs.
struct DriveColumns {
  std::vector<std::size_t> velocities{};  ///< ascending
  std::string volts{};                    ///< an input: supply of the rotors; empty: none
  std::string density{};                  ///< an input, of the water [kg/m³]
  std::string depth{};                    ///< an input: cuts logs into dives
};

/// A log: aligned rows, and the day of the first row.
struct DriveLog {
  log::Dataset data;
  std::string mission;
  double day = 0.0;
};

/// Judges every dive, or every log without a depth, by fit_factors(): the drag of each axis, the
/// gain of each command, the constant force of each axis. Requires the same inputs in all logs.
/// Throws InputError naming the first log where all logs together have too few rows.
HealthTable judge_drives(const std::vector<DriveLog>& logs, const DriveColumns& columns);

}  // namespace kelpie::health
