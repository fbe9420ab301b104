// SPDX-License-Identifier: Apache-2.0
#include "study/drivable_vehicle.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "identify/weak_form.hpp"
#include "study/tuning.hpp"

namespace kelpie::study {
namespace {

void advance_in_plane(const PlanarVehicle& vehicle, std::span<const double> speeds, double dt,
                      DriveMotion& motion) {
  PlanarVector velocity{motion.velocity[0], motion.velocity[1], motion.velocity[5]};
  const PlanarVector slope = vehicle.acceleration(velocity, speeds);
  PlanarVector middle = velocity;
  for (std::size_t axis = 0; axis < kPlanarAxes; ++axis) {
    middle[axis] += 0.5 * dt * slope[axis];
  }
  const PlanarVector better = vehicle.acceleration(middle, speeds);
  for (std::size_t axis = 0; axis < kPlanarAxes; ++axis) {
    velocity[axis] += dt * better[axis];
  }
  motion.velocity = {velocity[0], velocity[1], 0.0, 0.0, 0.0, velocity[2]};
  const double heading = motion.angles_rad[2] + 0.5 * dt * middle[2];
  motion.position_m[0] += dt * (middle[0] * std::cos(heading) - middle[1] * std::sin(heading));
  motion.position_m[1] += dt * (middle[0] * std::sin(heading) + middle[1] * std::cos(heading));
  motion.angles_rad[2] += dt * middle[2];
}

SixVector added(SixVector values, double factor, const SixVector& others) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] += factor * others[i];
  }
  return values;
}

// Rates of position and angles (Fossen 2011, eq. 2.18 and 2.28).
SixVector pose_rates(const Triple& angles, const SixVector& velocity) {
  const Eigen::Matrix3d to_world = (Eigen::AngleAxisd(angles[2], Eigen::Vector3d::UnitZ()) *
                                    Eigen::AngleAxisd(angles[1], Eigen::Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(angles[0], Eigen::Vector3d::UnitX()))
                                       .toRotationMatrix();
  const Eigen::Vector3d way = to_world * Eigen::Vector3d(velocity[0], velocity[1], velocity[2]);
  const double across = velocity[4] * std::sin(angles[0]) + velocity[5] * std::cos(angles[0]);
  return {way.x(),
          way.y(),
          way.z(),
          velocity[3] + across * std::tan(angles[1]),
          velocity[4] * std::cos(angles[0]) - velocity[5] * std::sin(angles[0]),
          across / std::cos(angles[1])};
}

ThrustCurve curve_of(const ParameterFit& fit, std::size_t thrusters) {
  ThrustCurve curve;
  for (std::size_t k = 0; k < kThrustCurve.size(); ++k) {
    curve.*kThrustCurve[k] = fit.parameters[SixAxisPlace::curve(thrusters) + k].value;
  }
  return curve;
}

// A vehicle on six axes under way. Thrusts follow at once behind the lag: a delay moves the whole
// drive in time.
struct SixAxisStep {
  SixAxisVehicle vehicle;
  ThrustCurve curve;
  double speed_factor;  // by the supply

  void operator()(std::span<const double> commands, double dt_s, DriveMotion& motion) const {
    motion.rotors.resize(commands.size(), 0.0);
    const double parts = std::max(1.0, std::ceil(dt_s / kTuning.plan.longest_step_s - 1e-9));
    for (int part = 0; part < static_cast<int>(parts); ++part) {
      advance(commands, dt_s / parts, motion);
    }
  }

  void advance(std::span<const double> commands, double dt, DriveMotion& motion) const {
    const double follows = curve.lag_s > 0.0 ? 1.0 - std::exp(-dt / curve.lag_s) : 1.0;
    std::vector<double> speeds(commands.size());
    for (std::size_t i = 0; i < commands.size(); ++i) {
      const double size =
          std::max(0.0, std::abs(commands[i]) - curve.dead_band) / (1.0 - curve.dead_band);
      motion.rotors[i] += follows * (std::copysign(size, commands[i]) - motion.rotors[i]);
      speeds[i] = speed_factor * motion.rotors[i];
    }
    const SixVector slope =
        vehicle.acceleration(motion.velocity, down_at(motion.angles_rad), speeds);
    const SixVector middle = added(motion.velocity, 0.5 * dt, slope);
    const SixVector pose = pose_rates(motion.angles_rad, middle);
    Triple half_way = motion.angles_rad;
    for (std::size_t i = 0; i < 3; ++i) {
      half_way[i] += 0.5 * dt * pose[3 + i];
    }
    motion.velocity =
        added(motion.velocity, dt, vehicle.acceleration(middle, down_at(half_way), speeds));
    for (std::size_t i = 0; i < 3; ++i) {
      motion.position_m[i] += dt * pose[i];
      motion.angles_rad[i] += dt * pose[3 + i];
    }
  }
};

}  // namespace

Triple down_at(const Triple& angles_rad) {
  return in_body(Triple{0.0, 0.0, 1.0}, angles_rad);
}

DrivablePlanarVehicle::DrivablePlanarVehicle(const ExpectedPlanarFit& expected, ThrusterRange range,
                                             double row_s)
    : expected_(expected), push_(expected.now().vehicle(), std::move(range)), row_s_(row_s) {}

DriveStep DrivablePlanarVehicle::vehicle_of(const ParameterFit& fit) const {
  PlanarFit planar;
  planar.parameters = fit.parameters;
  return [vehicle = planar.vehicle()](std::span<const double> speeds, double dt_s,
                                      DriveMotion& motion) {
    advance_in_plane(vehicle, speeds, dt_s, motion);
  };
}

WeakRows DrivablePlanarVehicle::windows(const SixAxisRows& drive) const {
  PlanarRows rows{.thrusters = {},
                  .times_s = drive.times_s,
                  .velocities = {},
                  .speeds = drive.commands,
                  .starts = drive.starts};
  rows.thrusters.resize(push_.range().most.size());
  for (std::size_t i = 0; i < drive.velocities.size(); i += kSixAxes) {
    for (const std::size_t axis : {0U, 1U, 5U}) {
      rows.velocities.push_back(drive.velocities[i + axis]);
    }
  }
  return weak_rows(rows, {});
}

DrivableSixAxisVehicle::DrivableSixAxisVehicle(const ExpectedSixAxisFit& expected,
                                               ThrusterRange range, double volts_ratio)
    : expected_(expected),
      volts_ratio_(volts_ratio),
      push_(expected.now(), std::move(range),
            std::pow(volts_ratio, expected.now().curve.exponent)) {}

DriveStep DrivableSixAxisVehicle::vehicle_of(const ParameterFit& fit) const {
  SixAxisFit six = expected_.now();
  six.parameters = fit.parameters;
  six.curve = curve_of(fit, six.thrusters.size());
  return SixAxisStep{SixAxisVehicle(six), six.curve,
                     std::pow(volts_ratio_, 0.5 * six.curve.exponent)};
}

WeakRows DrivableSixAxisVehicle::windows(const SixAxisRows& drive) const {
  SixAxisRows rows = drive;
  rows.thrusters = expected_.now().thrusters;
  rows.volts.assign(rows.rows(), volts_ratio_);
  return expected_.windows(rows);
}

double DrivableSixAxisVehicle::row_s() const {
  return std::min(0.1, expected_.now().window_s / kTuning.plan.rows_per_window);
}

}  // namespace kelpie::study
