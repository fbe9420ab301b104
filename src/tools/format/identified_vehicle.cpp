// SPDX-License-Identifier: Apache-2.0
#include "format/identified_vehicle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "format/tuning.hpp"
#include "kelpie/core/error.hpp"
#include "study/tuning.hpp"

namespace kelpie::format {
namespace {

using vehicle::VehicleParameters;

double revolutions(const std::string& unit) {
  if (unit.empty() || unit == "rev/s" || unit == "rev s^-1" || unit == "rps" || unit == "Hz" ||
      unit == "s^-1") {
    return 1.0;
  }
  if (unit == "rad/s" || unit == "rad s^-1") {
    return 0.5 / std::numbers::pi;
  }
  if (unit == "rpm" || unit == "rev min^-1" || unit == "min^-1") {
    return 1.0 / 60.0;
  }
  throw InputError("--units", "'" + unit +
                                  "' is no thruster's speed that simulators know; they "
                                  "take rev/s, rad/s or rpm");
}

// What a log in the plane doesn't show, where no vehicle file tells it.
VehicleParameters assumed(const PlanarVehicle& plane, double mass_kg) {
  VehicleParameters body;
  body.mass_kg = mass_kg;
  const double yaw = plane.yaw_inertia * mass_kg / plane.surge_inertia;
  const double sway_added = plane.sway_inertia - mass_kg;
  const double yaw_added = plane.yaw_inertia - yaw;
  body.inertia_kg_m2 = Eigen::Vector3d(kTuning.roll_over_yaw * yaw, yaw, yaw).asDiagonal();
  body.centre_of_gravity_m = {0.0, 0.0, kTuning.low_centre_m};
  body.added_mass(2, 2) = sway_added;
  body.added_mass(3, 3) = kTuning.roll_over_yaw * yaw_added;
  body.added_mass(4, 4) = yaw_added;
  body.linear_damping << 0.0, 0.0, plane.linear_drag[1], plane.linear_drag[2], plane.linear_drag[2],
      0.0;
  body.quadratic_damping << 0.0, 0.0, plane.quadratic_drag[1], plane.quadratic_drag[2],
      plane.quadratic_drag[2], 0.0;
  const double heave = plane.sway_inertia;
  body.hold = {.depth_p = heave * kTuning.depth_per_s * kTuning.depth_per_s,
               .depth_i = kTuning.depth_integral * heave,
               .depth_d = kTuning.depth_damping * heave * kTuning.depth_per_s,
               .pitch_p = plane.yaw_inertia * kTuning.pitch_per_s,
               .pitch_d = plane.yaw_inertia * kTuning.pitch_per_s};
  return body;
}

void set_plane(const PlanarVehicle& plane, VehicleParameters& body) {
  const double yaw =
      body.inertia_kg_m2(2, 2) + body.mass_kg * body.centre_of_gravity_m.head<2>().squaredNorm();
  const double coupling = body.mass_kg * body.centre_of_gravity_m(0);
  body.added_mass(0, 0) = plane.surge_inertia - body.mass_kg;
  body.added_mass(1, 1) = plane.sway_inertia - body.mass_kg;
  body.added_mass(5, 5) = plane.yaw_inertia - yaw;
  body.added_mass(1, 5) = body.added_mass(5, 1) = plane.sway_yaw_inertia - coupling;
  constexpr std::array<Eigen::Index, kPlanarAxes> kOfSix{0, 1, 5};
  for (std::size_t axis = 0; axis < kPlanarAxes; ++axis) {
    body.linear_damping(kOfSix[axis]) = plane.linear_drag[axis];
    body.quadratic_damping(kOfSix[axis]) = plane.quadratic_drag[axis];
  }
}

void turn_to_frd(PlanarVehicle& plane) {
  for (PlanarThruster& thruster : plane.thrusters) {
    thruster.angle_rad = -thruster.angle_rad;
    thruster.arm_m = -thruster.arm_m;
  }
  plane.constant_force[1] = -plane.constant_force[1];
  plane.constant_force[2] = -plane.constant_force[2];
}

// The place on its line of action that is nearest to the origin.
vehicle::Thruster in_six(const PlanarThruster& thruster, double greatest_rps) {
  const double c = std::cos(thruster.angle_rad);
  const double s = std::sin(thruster.angle_rad);
  return {.forward = thruster.forward,
          .reverse = thruster.reverse,
          .position_m = {thruster.arm_m * s, -thruster.arm_m * c, 0.0},
          .direction = {c, s, 0.0},
          .max_speed_rps = greatest_rps};
}

bool is_along(const PlanarThruster& thruster, double cosine_or_sine) {
  return std::abs(cosine_or_sine) > std::cos(kTuning.most_off_rad) && thruster.forward > 0.0 &&
         thruster.reverse > 0.0;
}

// The simulator has two thrusters along surge, one along sway and two vertical ones.
void fill_slots(IdentifiedVehicle& result, bool has_verticals) {
  std::vector<std::size_t> surge;
  std::vector<std::size_t> sway;
  for (std::size_t i = 0; i < result.thrusters.size(); ++i) {
    const PlanarThruster& thruster = result.thrusters[i];
    if (is_along(thruster, std::cos(thruster.angle_rad))) {
      surge.push_back(i);
    } else if (is_along(thruster, std::sin(thruster.angle_rad))) {
      sway.push_back(i);
    }
  }
  if (surge.size() != 2 || sway.size() != 1 || result.thrusters.size() != 3) {
    return;
  }
  result.body.thrusters.resize(vehicle::kPlanarThrusterCount);
  const auto put = [&](std::size_t slot, std::size_t i) {
    result.body.thrusters[slot] = in_six(result.thrusters[i], result.greatest_rps[i]);
    result.body.thrusters[slot].name = vehicle::planar_thruster_names()[slot];
  };
  const auto side = [&](std::size_t i) {  // negative: left of the middle
    return in_six(result.thrusters[i], 0.0).position_m(1);
  };
  std::ranges::sort(surge, {}, side);
  put(vehicle::kSurgeLeft, surge[0]);
  put(vehicle::kSurgeRight, surge[1]);
  put(vehicle::kSway, sway[0]);
  if (!has_verticals) {
    for (const auto slot : {vehicle::kVerticalFront, vehicle::kVerticalRear}) {
      vehicle::Thruster& vertical = result.body.thrusters[slot];
      vertical = result.body.thrusters[vehicle::kSway];
      vertical.name = vehicle::planar_thruster_names()[slot];
      vertical.direction = Eigen::Vector3d::UnitZ();
      vertical.position_m = {
          slot == vehicle::kVerticalFront ? kTuning.vertical_arm_m : -kTuning.vertical_arm_m, 0.0,
          0.0};
    }
  }
  result.has_slots = true;
}

}  // namespace

IdentifiedVehicle identified_vehicle(const study::Identification& found, Frame frame,
                                     const std::optional<VehicleParameters>& base,
                                     const std::string& base_file) {
  PlanarVehicle plane = found.fit.vehicle();
  if (frame == Frame::flu) {
    turn_to_frd(plane);
  }
  IdentifiedVehicle result;
  result.speed_unit = "as the log's units say";
  for (std::size_t i = 0; i < plane.thrusters.size(); ++i) {
    PlanarThruster thruster = plane.thrusters[i];
    const double turns = revolutions(found.speed_units[i]);
    if (found.speed_units[i].empty()) {
      result.speed_unit = "taken for rev/s: the log's units don't say";
    }
    const ParameterState reverse = found.fit.parameters[PlanarPlace::thruster(i) + 1].state;
    result.reverse_told.push_back(reverse != ParameterState::not_told);
    if (!result.reverse_told.back()) {
      thruster.reverse = thruster.forward;
    }
    thruster.forward /= turns * turns;
    thruster.reverse /= turns * turns;
    result.thrusters.push_back(thruster);
    result.greatest_rps.push_back(found.greatest_speeds[i] * turns);
  }
  const double mass_kg = found.mass_kg.value_or(plane.surge_inertia /
                                                (1.0 + study::kTuning.identification.added_share));
  result.body = base.value_or(assumed(plane, mass_kg));
  const bool has_verticals = base && vehicle::drives_in_plane(*base);
  result.body.mass_kg = mass_kg;
  result.rest = base
                    ? "heave, roll, pitch, buoyancy, rotors and hold as in " + base_file
                    : "heave, roll, pitch, buoyancy and hold assumed: heave as sway, pitch as yaw, "
                      "roll a third of it, the centre of gravity 5 cm low";
  if (!found.mass_kg) {
    result.rest += "; the rigid body's mass assumed, surge inertia / 1.2";
  }
  result.constant_force = plane.constant_force;
  set_plane(plane, result.body);
  fill_slots(result, has_verticals);
  return result;
}

}  // namespace kelpie::format
