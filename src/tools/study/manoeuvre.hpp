// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kelpie/motion/planar_fit.hpp"

namespace kelpie::study {

/// Thruster speeds that hold for a time.
struct HeldSpeeds {
  double duration_s = 0.0;  ///< a whole number of kManoeuvreStepS
  std::vector<double> speeds{};
};

/// One element of a drive that tells parameters: speeds of all thrusters over time.
struct Manoeuvre {
  std::string name;  ///< "sway doublet, 12 s, 100 %"
  std::vector<HeldSpeeds> parts{};

  double duration_s() const;
};

/// Speeds change at multiples of this time [s].
inline constexpr double kManoeuvreStepS = 0.5;

/// What the thrusters of a vehicle may be commanded, in the fit's unit.
struct ThrusterRange {
  std::vector<double> least;  ///< full astern, ≤ 0
  std::vector<double> most;   ///< full ahead, ≥ 0
};

/// Thruster speeds with the largest force in a direction (surge, sway, yaw; moments count as forces
/// at the thrusters' mean arm), times an amplitude in (0, 1]. Thrusts of least norm.
class PlanarPush {
 public:
  PlanarPush(const PlanarVehicle& vehicle, ThrusterRange range);

  bool reaches(std::size_t axis) const;
  std::vector<double> speeds(const PlanarVector& direction, double amplitude) const;
  const ThrusterRange& range() const { return range_; }

 private:
  ThrusterRange range_;
  std::vector<double> forces_;   ///< axes × thrusters, at full speed
  std::vector<double> inverse_;  ///< thrusters × axes
};

/// The dictionary (Fossen 2011, ch. 7.3 and 12.3; ITTC 7.5-06-02-05; doublets and sequences:
/// Morelli & Klein 2016, ch. 9): steps and doublets of surge, sway and yaw where the thrusters push
/// so, zig-zags, circles, steps and doublets of every thruster, and pseudo-random binary sequences
/// of one and of all thrusters, each at several periods and amplitudes. Deterministic.
std::vector<Manoeuvre> manoeuvres_for(const PlanarPush& push);

}  // namespace kelpie::study
