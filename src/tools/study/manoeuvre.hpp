// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "identify/six_axis_fit.hpp"
#include "kelpie/core/random.hpp"
#include "kelpie/identify/planar_fit.hpp"

namespace kelpie::study {

/// Thruster speeds that hold for a time.
struct HeldSpeeds {
  double duration_s = 0.0;  ///< a whole number of kManoeuvreStepS
  std::vector<double> speeds{};
};

/// An element of a drive: speeds of all thrusters over time.
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

  double full(std::size_t thruster, double sign) const {
    return sign < 0.0 ? least[thruster] : most[thruster];
  }
};

/// Pushes of the thrusters along surge, sway and yaw, or along all six axes. A direction has a
/// number per axis; moments count as forces at the thrusters' mean arm. Speeds are in the fit's
/// unit, on six axes commands as shares of full.
class ThrusterPush {
 public:
  explicit ThrusterPush(ThrusterRange range) : range_(std::move(range)) {}
  virtual ~ThrusterPush() = default;

  virtual std::size_t axes() const = 0;
  virtual bool reaches(std::size_t axis) const = 0;
  /// Speeds with the largest force in a direction, times an amplitude in (0, 1]. Thrusts of least
  /// norm.
  virtual std::vector<double> speeds(std::span<const double> direction, double amplitude) const = 0;
  /// `speeds` with further thrusts, on six axes, against the weight in water and the moments of a
  /// level vehicle, as far as the range goes.
  virtual std::vector<double> held(std::vector<double> speeds) const { return speeds; }
  const ThrusterRange& range() const { return range_; }

 protected:
  ThrusterRange range_;
};

/// Of a vehicle in the plane.
class PlanarPush : public ThrusterPush {
 public:
  PlanarPush(const PlanarVehicle& vehicle, ThrusterRange range);

  std::size_t axes() const override { return kPlanarAxes; }
  bool reaches(std::size_t axis) const override;
  std::vector<double> speeds(std::span<const double> direction, double amplitude) const override;

 private:
  std::vector<double> forces_;   ///< axes × thrusters, at full speed
  std::vector<double> inverse_;  ///< thrusters × axes
};

/// Of a vehicle on six axes, whose thrusters follow ThrustCurve at a factor of the thrust by their
/// supply.
class SixAxisPush : public ThrusterPush {
 public:
  SixAxisPush(const SixAxisFit& fit, ThrusterRange range, double supply);

  std::size_t axes() const override { return kSixAxes; }
  /// Whether thrusters push the axis without as large a push on other axes.
  bool reaches(std::size_t axis) const override;
  std::vector<double> speeds(std::span<const double> direction, double amplitude) const override;
  std::vector<double> held(std::vector<double> speeds) const override;

 private:
  double thrust_of(std::size_t thruster, double command) const;
  double command_of(std::size_t thruster, double thrust) const;

  std::vector<double> ahead_, astern_;  ///< thrust of full commands
  double dead_band_;
  std::vector<double> reached_;  ///< of each axis by a push along the axis
  std::vector<double> inverse_;  ///< thrusters × axes
  std::vector<double> holding_;  ///< thrusts
};

/// The dictionary of the plane (Fossen 2011, ch. 7.3 and 12.3; ITTC 7.5-06-02-05; doublets and
/// sequences: Morelli & Klein 2016, ch. 9): steps and doublets of each axis where the thrusters
/// push so and of every thruster, zig-zags, circles, and pseudo-random binary sequences of one and
/// of all thrusters, each at several periods and amplitudes. Deterministic.
std::vector<Manoeuvre> manoeuvres_for(const ThrusterPush& push);

/// Draws of speeds evenly distributed over the range of all thrusters, or along some axes, held for
/// equal times: "surge and pitch, 3 holds of 0.5 s". Deterministic.
class ManoeuvreDraws {
 public:
  /// `push` has to outlive the draws.
  explicit ManoeuvreDraws(const ThrusterPush& push);

  /// At full amplitude, not held() yet. Allocates.
  Manoeuvre next();

 private:
  std::vector<double> drawn_speeds(const std::vector<double>& weights);
  std::vector<double> drawn_weights();

  const ThrusterPush& push_;
  RandomStream random_;
};

/// A draw at a share of its amplitude, held(): "surge and pitch, 3 holds of 0.5 s, 45 %".
Manoeuvre at_amplitude(Manoeuvre draw, double amplitude, const ThrusterPush& push);

}  // namespace kelpie::study
