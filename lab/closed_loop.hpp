// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "kelpie/model/dynamics_model.hpp"
#include "lab/controllers.hpp"
#include "simulator/parameters.hpp"

namespace kelpie::lab {

/// A change of the vehicle or the water in the middle of a mission.
enum class Mishap {
  none,
  thruster,         ///< the right surge thruster gives half its force
  payload,          ///< 20 kg in weight and buoyancy, 0.2 m ahead, and 30 % more drag
  current,          ///< a current of 0.08 m/s sets in, from a random direction
  weak_thruster,    ///< the right surge thruster gives a fifth of its force
  outage,           ///< velocity log and position are silent for MissionTimes::during_s
  outage_thruster,  ///< the same; the right surge thruster gives half since the scores began
  outage_current,   ///< the same; the current has been there since the scores began
};
inline constexpr std::array kMishaps{
    Mishap::none,          Mishap::thruster, Mishap::payload,         Mishap::current,
    Mishap::weak_thruster, Mishap::outage,   Mishap::outage_thruster, Mishap::outage_current};
bool has_outage(Mishap mishap);
std::string mishap_name(Mishap mishap);

/// Lengths of a mission [s].
struct MissionTimes {
  double settle_s = 60.0;   ///< not scored
  double before_s = 240.0;  ///< until the mishap
  double during_s = 60.0;   ///< from the mishap on
  double after_s = 240.0;

  double all_s() const { return settle_s + before_s + during_s + after_s; }
};

/// A mission of one seed.
struct Mission {
  PathKind path = PathKind::lawn_mower;
  Mishap mishap = Mishap::none;
  MissionTimes times{};
  std::uint64_t seed = 1;  ///< of the noise, and of a current's direction
};

/// The errors of a mission: root mean square distance to the reference [m].
struct MissionErrors {
  double before = 0.0;
  double during = 0.0;
  double after = 0.0;
  double fallback_share = 0.0;   ///< of the mission time
  std::vector<double> time_s{};  ///< a value per second, as the two fields below
  std::vector<double> error_m{};
  std::vector<Eigen::Vector2d> track{};  ///< position
};

/// The simulated vehicle under a controller. Position and heading are known to 5 mm and 2 mrad
/// (white, at 10 Hz), velocities have noise as recorded. During station keeping a current of 0.08
/// m/s flows from the start on, and turns by 90° at the mishap `current`.
MissionErrors fly(const simulator::VehicleParameters& vehicle, const Mission& mission,
                  Controller& controller);

/// A model after `seconds` of driving the nominal vehicle as in a scenario, at 5 Hz.
DynamicsModel commissioned(const simulator::VehicleParameters& vehicle, double seconds,
                           std::uint64_t seed);

}  // namespace kelpie::lab
