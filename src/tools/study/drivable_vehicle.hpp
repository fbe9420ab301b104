// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "identify/expected_fit.hpp"
#include "identify/expected_six_axis_fit.hpp"
#include "kelpie/motion/frame.hpp"
#include "study/manoeuvre.hpp"

namespace kelpie::study {

/// Where a vehicle is, and how it moves: in the plane in the frame of the log, without heave, roll
/// and pitch; on six axes FRD, from NED.
struct DriveMotion {
  SixVector velocity{};  ///< m/s, rad/s
  Triple position_m{};
  Triple angles_rad{};           ///< roll, pitch, heading
  std::vector<double> rotors{};  ///< on six axes: speeds behind the lag; empty: at rest
};

/// Advances a motion by a time [s] under speeds of the thrusters.
using DriveStep =
    std::function<void(std::span<const double> speeds, double dt_s, DriveMotion& motion)>;

/// The vehicle of a log, in the plane or on six axes, as a plan of drives needs the vehicle.
class DrivableVehicle {
 public:
  virtual ~DrivableVehicle() = default;

  virtual const ExpectedFit& expected() const = 0;
  virtual const ThrusterPush& push() const = 0;
  /// A vehicle with the values of a fit like expected().now().
  virtual DriveStep vehicle_of(const ParameterFit& fit) const = 0;
  /// The windows of a drive for expected(). In the plane heave, roll, pitch and the direction of
  /// gravity don't count.
  virtual WeakRows windows(const SixAxisRows& drive) const = 0;
  /// Time between the rows of a simulated drive.
  virtual double row_s() const = 0;
};

/// In the plane. `expected` has to outlive the vehicle.
class DrivablePlanarVehicle : public DrivableVehicle {
 public:
  /// `row_s`: time between rows of the log.
  DrivablePlanarVehicle(const ExpectedPlanarFit& expected, ThrusterRange range, double row_s);

  const ExpectedFit& expected() const override { return expected_; }
  const ThrusterPush& push() const override { return push_; }
  DriveStep vehicle_of(const ParameterFit& fit) const override;
  WeakRows windows(const SixAxisRows& drive) const override;
  double row_s() const override { return row_s_; }

 private:
  const ExpectedPlanarFit& expected_;
  PlanarPush push_;
  double row_s_;
};

/// On six axes. `expected` has to outlive the vehicle.
class DrivableSixAxisVehicle : public DrivableVehicle {
 public:
  /// `volts_ratio`: supply over the nominal supply, constant along the drive.
  DrivableSixAxisVehicle(const ExpectedSixAxisFit& expected, ThrusterRange range,
                         double volts_ratio = 1.0);

  const ExpectedFit& expected() const override { return expected_; }
  const ThrusterPush& push() const override { return push_; }
  DriveStep vehicle_of(const ParameterFit& fit) const override;
  WeakRows windows(const SixAxisRows& drive) const override;
  double row_s() const override;

 private:
  const ExpectedSixAxisFit& expected_;
  double volts_ratio_;
  SixAxisPush push_;
};

/// The direction of gravity in the body, FRD, at roll and pitch (Fossen 2011, eq. 4.6).
Triple down_at(const Triple& angles_rad);

}  // namespace kelpie::study
