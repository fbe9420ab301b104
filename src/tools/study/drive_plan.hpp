// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "kelpie/identify/planar_fit.hpp"
#include "study/drivable_vehicle.hpp"
#include "study/manoeuvre.hpp"

namespace kelpie::study {

/// Bounds of a drive, kept by the identified vehicle and by vehicles as different as the errors
/// allow.
struct DriveBounds {
  double time_s = 120.0;   ///< of the whole drive
  double speed_m_s = 1.0;  ///< greatest speed through the water
  double radius_m = 10.0;  ///< greatest distance from the origin, level
  // On six axes.
  double depth_m = 2.0;    ///< greatest change of depth from the origin
  double tilt_rad = 0.52;  ///< greatest roll or pitch
};

/// The greatest values on the way, of all possible vehicles.
struct DriveExtent {
  double farthest_m = 0.0;
  double fastest_m_s = 0.0;
  double depth_m = 0.0;
  double tilt_rad = 0.0;

  void include(const DriveMotion& motion);
  bool within(const DriveBounds& bounds) const;
};

/// Vehicles that the fit allows: the estimate, then draws from the errors. A parameter that is not
/// told counts as known to a third.
class PossibleVehicles {
 public:
  PossibleVehicles(const DrivableVehicle& vehicle, const DriveBounds& bounds,
                   const DriveMotion& start);

  /// Drives every vehicle and lets the vehicles coast. False, without a change, if a vehicle leaves
  /// the bounds.
  bool drive(const Manoeuvre& manoeuvre);
  bool allows(const Manoeuvre& manoeuvre) const;

  const DriveExtent& extent() const { return extent_; }

 private:
  bool advance(const Manoeuvre& manoeuvre, std::vector<DriveMotion>& motions,
               DriveExtent& extent) const;

  DriveBounds bounds_;
  std::vector<DriveStep> vehicles_;
  std::vector<DriveMotion> motions_;
  DriveExtent extent_;
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

/// Gives forces a unit; errors of the fit count in this unit.
using FitScale = std::function<void(ParameterFit&)>;

/// To tell parameters (places in the fit): numbers are half widths of 90 % intervals over the sizes
/// (interval_share()), the aim is `share`; parameters at a bound have no size and are left out.
/// Missing is Σ ln(1 + (number / share)²): A-optimal in logarithms as far as the aim (Goodwin &
/// Payne 1977, ch. 6). `expected` has to outlive the goal. Throws InputError without a parameter.
DriveGoal telling_goal(const ExpectedFit& expected, std::vector<std::size_t> parameters,
                       double share, FitScale scale);

/// To tell two changes of the vehicle apart, by `share` of the parameters' values: each a name of
/// wanted_places(), a thruster by its thrust, "all_thrusters", "load" (all inertias), or a constant
/// force ("surge_force", "yaw_moment"), by `share` of the axis' drag at 1 m/s or 1 rad/s. The
/// number is the evidence in nats (ExpectedFit::evidence()), the aim kDiagnosis.named_margin_nats.
/// `expected` has to outlive the goal. Throws InputError on another name, and on equal changes.
DriveGoal parting_goal(const ExpectedFit& expected, const std::string& first,
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
  std::vector<DriveMotion> track{};      ///< of the identified vehicle, every kManoeuvreStepS
  DriveExtent extent{};
  bool reached = false;  ///< the aim

  double duration_s() const;
};

/// Places of the parameters with all words of one of the names ("sway_drag": sway_linear_drag and
/// sway_quadratic_drag; "th1"); without names all masses, drags, thrusts, arms in the plane and the
/// righting moment. Throws InputError on a name without a parameter.
std::vector<std::size_t> wanted_places(const ParameterFit& fit,
                                       const std::vector<std::string>& names);

/// Half width of a parameter's 90 % interval over its size: the value; one radian of a direction;
/// the geometric mean of the inertias that a coupling couples; the righting moment for the moments
/// of roll and pitch; 1 s of a delay, 1 of a dead band and of an exponent.
double interval_share(const ParameterFit& fit, std::size_t place);

/// Chooses manoeuvre by manoeuvre, each time the largest fall of the missing amount per second,
/// until the goal is reached, or no further manoeuvre fits the bounds. Sequential design of
/// experiments for dynamic systems: Goodwin & Payne 1977, ch. 6. Throws InputError where no
/// manoeuvre fits the bounds. Cost: manoeuvres × (steps + terms³) per choice. Allocates.
/// Deterministic.
DrivePlan plan_drive(const DrivableVehicle& vehicle, const DriveBounds& bounds,
                     const DriveGoal& goal, const DriveMotion& start = {});

}  // namespace kelpie::study
