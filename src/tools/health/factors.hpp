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
  std::vector<std::size_t> velocities{};  ///< of the equations
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

/// Judges every dive, or every log without a depth:
/// 1. The equation of motion of MotionTerms::open_loop() and a constant, in the weak form of
///    fit_planar(), fitted to all episodes together.
/// 2. Of each episode, factors on groups of these terms, jointly by Huber's least squares: the
///    damping of each axis, all that a command does, and the constant of each axis. The rest of the
///    equation (inertia, Coriolis forces) is held.
/// 3. Errors by a sandwich from 24 pieces of the episode, with Student's t.
/// Terms of commands go with a power of the supply's voltage, which all episodes tell together;
/// terms of damping and commands go with the density of the water.
/// A factor with an error above kTuning.most_error is not told. Requires velocities among the
/// inputs, and the same inputs in all logs. Throws InputError naming the log where all episodes
/// together have too few rows.
HealthTable judge_drives(const std::vector<DriveLog>& logs, const DriveColumns& columns);

}  // namespace kelpie::health
