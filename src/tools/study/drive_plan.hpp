// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "kelpie/core/random.hpp"
#include "kelpie/motion/planar_fit.hpp"
#include "motion/expected_fit.hpp"
#include "study/manoeuvre.hpp"

namespace kelpie::study {

/// Where a vehicle in the plane is, and how it moves.
struct PlanarMotion {
  PlanarVector velocity{};
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;
};

/// Bounds that a drive keeps by the identified vehicle, and by vehicles as different from it as its
/// errors allow.
struct DriveBounds {
  double time_s = 120.0;   ///< of the whole drive
  double speed_m_s = 1.0;  ///< greatest speed through the water
  double radius_m = 10.0;  ///< greatest distance from the origin
};

/// Vehicles that the fit allows: the estimate, then draws from the errors. A parameter that is not
/// told counts as known to a third.
class PossibleVehicles {
 public:
  PossibleVehicles(const PlanarFit& fit, const DriveBounds& bounds, const PlanarMotion& start);

  /// Drives all of them, and lets them coast. Whether all kept the bounds; nothing changes if not.
  bool drive(const Manoeuvre& manoeuvre);
  bool allows(const Manoeuvre& manoeuvre) const;

  double farthest_m() const { return farthest_m_; }
  double fastest_m_s() const { return fastest_m_s_; }

 private:
  bool advance(const Manoeuvre& manoeuvre, std::vector<PlanarMotion>& motions, double& farthest_m,
               double& fastest_m_s) const;

  DriveBounds bounds_;
  std::vector<PlanarVehicle> vehicles_;
  std::vector<PlanarMotion> motions_;
  double farthest_m_ = 0.0;
  double fastest_m_s_ = 0.0;
};

/// How far a goal is after windows of a drive (none: before the drive).
struct DriveProgress {
  std::vector<double> numbers{};  ///< of the countdown, an entry per name
  double missing = 0.0;           ///< falls on the way
  bool reached = false;
};

/// What a drive is for.
struct DriveGoal {
  std::vector<std::string> names;  ///< of the numbers
  std::function<DriveProgress(const WeakRows& windows)> progress;
};

/// Gives forces their unit; the errors of a fit are those with this unit.
using FitScale = std::function<void(PlanarFit&)>;

/// To tell parameters (places in the fit): numbers are half widths of 90 % intervals over the sizes
/// (interval_share()), the aim is `share`. Missing is Σ ln(1 + (number / share)²): A-optimal in
/// logarithms as far as the aim (Goodwin & Payne 1977, ch. 6). `expected` has to outlive
/// the goal. Throws InputError without a parameter.
DriveGoal telling_goal(const ExpectedPlanarFit& expected, std::vector<std::size_t> parameters,
                       double share, FitScale scale);

/// To tell two changes of the vehicle apart, each a name of wanted_places() or "load", by `share`
/// of the parameters' values: a thruster by its thrust. The number is the evidence in nats
/// (ExpectedPlanarFit::evidence()), the aim kDiagnosis.named_margin_nats. `expected` has to outlive
/// the goal. Throws InputError on another name, and on equal changes.
DriveGoal parting_goal(const ExpectedPlanarFit& expected, const std::string& first,
                       const std::string& second, double share);

/// A moment of the countdown.
struct DriveMoment {
  double t_s = 0.0;
  std::string manoeuvre{};        ///< that ended here; empty at the start
  std::vector<double> numbers{};  ///< of the goal
};

/// A drive, and what is known of the parameters on the way.
struct DrivePlan {
  std::vector<Manoeuvre> manoeuvres{};
  std::vector<std::string> names{};      ///< of the countdown's numbers
  std::vector<DriveMoment> countdown{};  ///< the first before the drive
  std::vector<double> x_m{}, y_m{};      ///< of the identified vehicle, every kManoeuvreStepS
  double farthest_m = 0.0;               ///< of all possible vehicles
  double fastest_m_s = 0.0;
  bool reached = false;  ///< the aim

  double duration_s() const;
};

/// Places of the parameters with all words of one of the names ("sway_drag": sway_linear_drag and
/// sway_quadratic_drag; "th1"); without names all masses, drags, thrusts and arms but the coupling
/// of sway and yaw. Throws InputError on a name without a parameter.
std::vector<std::size_t> wanted_places(const PlanarFit& fit, const std::vector<std::string>& names);

/// Half width of a parameter's 90 % interval over its size: the value, one radian of a direction,
/// the geometric mean of the inertias of sway and yaw for their coupling.
double interval_share(const PlanarFit& fit, std::size_t place);

/// Chooses manoeuvres one by one, each time the one after which least is missing per second of it,
/// until the goal is reached, or no further manoeuvre fits the bounds. Sequential design of
/// experiments for dynamic systems: Goodwin & Payne 1977, ch. 6. `row_s`: time between rows of the
/// log. Throws InputError where no manoeuvre fits the bounds. Cost: manoeuvres × (steps + terms³)
/// per choice. Allocates. Deterministic.
DrivePlan plan_drive(const PlanarFit& fit, const PlanarPush& push, const DriveBounds& bounds,
                     const DriveGoal& goal, double row_s, const PlanarMotion& start = {});

}  // namespace kelpie::study
