// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kelpie/motion/diagnosis.hpp"
#include "vehicle/scenario.hpp"

namespace kelpie::lab {

/// A change of the simulated vehicle, and the expected diagnosis.
struct DiagnosisCase {
  std::string name;      ///< without the strength: "thruster th1"
  int effect = 0;        ///< strength in percent; 0: without strength
  bool special = false;  ///< two causes, or a load off the centre: not a target of issue 20's table
  vehicle::Configuration configuration;
  std::vector<Cause> truth;  ///< one or two; intervals unused
};

/// Every single cause with effects of 20, 40, 60 and 80 percent, and pairs of them:
///
///     thruster   th1, th2, th3: thrust reduced by the share
///     drag       surge, sway, yaw: linear and quadratic damping increased by the share
///     load       in the middle, neutral: inertia in surge increased by the share; also 0.2 m ahead
///     force      back in surge, and a tether at the stern: a share of the greatest thrust
///     scale      of u, v, r: readings increased by the share
///     bias       of u, v, r: a share of 0.25 m/s, 0.1 m/s, 0.2 rad/s
///     frozen     u, v, r
///     two        of 40 percent each
std::vector<DiagnosisCase> diagnosis_cases(const vehicle::VehicleParameters& vehicle);

/// "thruster", "drag", … of a cause of the simulated vehicle, with its column or axis.
std::string case_name(const Cause& cause);

}  // namespace kelpie::lab
