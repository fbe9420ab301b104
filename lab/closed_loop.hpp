// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "kelpie/model/dynamics_model.hpp"
#include "lab/controllers.hpp"
#include "lab/mission_path.hpp"
#include "vehicle/parameters.hpp"

namespace kelpie::lab {

/// What becomes of the vehicle or the water in the middle of a mission.
enum class Mishap {
  none,
  thruster,  ///< the right surge thruster gives half its force
  payload,   ///< 20 kg in weight and buoyancy, 0.2 m ahead, and 30 % more drag
  current,   ///< one of 0.08 m/s sets in, from a direction drawn
};
inline constexpr std::array kMishaps{Mishap::none, Mishap::thruster, Mishap::payload,
                                     Mishap::current};
std::string mishap_name(Mishap mishap);

/// Lengths of a mission [s].
struct MissionTimes {
  double settle_s = 60.0;   ///< not judged
  double before_s = 240.0;  ///< until the mishap
  double during_s = 60.0;   ///< from it on
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

/// What came of it: root mean square distance to where the vehicle should be [m].
struct MissionErrors {
  double before = 0.0;
  double during = 0.0;
  double after = 0.0;
  double fallback_share = 0.0;   ///< of all the time
  std::vector<double> time_s{};  ///< one per second, as the two below
  std::vector<double> error_m{};
  std::vector<Eigen::Vector2d> track{};  ///< where it was
};

/// The simulated vehicle under a controller. Position and heading are known to 5 mm and 2 mrad
/// (white, at 10 Hz), velocities have noise as recorded. While it keeps station there is a current
/// of 0.08 m/s from the start on, which turns by 90° where a current sets in.
MissionErrors fly(const vehicle::VehicleParameters& vehicle, const Mission& mission,
                  Controller& controller);

/// `seconds` of driving the nominal vehicle as a scenario does, learned at 5 Hz.
DynamicsModel commissioned(const vehicle::VehicleParameters& vehicle, double seconds,
                           std::uint64_t seed);

}  // namespace kelpie::lab
