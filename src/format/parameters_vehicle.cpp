// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>

#include "format/parameters.hpp"
#include "kelpie/core/error.hpp"
#include "vehicle/parameters.hpp"

namespace kelpie::format {
namespace {

template <typename Vector>
std::string numbers_toml(const Vector& values) {
  std::string text;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    text += fmt::format("{}{:.6g}", i > 0 ? ", " : "", values(i) + 0.0);
  }
  return "[" + text + "]";
}

template <typename Matrix>
std::string rows_toml(const Matrix& matrix) {
  std::string text;
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    text += "  " + numbers_toml(matrix.row(row)) + ",\n";
  }
  return "[\n" + text + "]";
}

// One line of a comment, whatever the log's file is called.
std::string comment_line(std::string text) {
  for (char& letter : text) {
    letter = static_cast<unsigned char>(letter) < ' ' ? '?' : letter;
  }
  return text;
}

}  // namespace

std::string vehicle_toml(const IdentifiedVehicle& vehicle, const std::string& source) {
  const vehicle::VehicleParameters& body = vehicle.body;
  std::string text = fmt::format(
      "# Identified by `kelpie identify` from {}.\n"
      "# Surge, sway, yaw and the lateral thrusters are identified; {}.\n"
      "# Speeds of thrusters in rev/s, {}. Constant forces ({:.3g} N, {:.3g} N, {:.3g} N m) aren't "
      "part of a vehicle file.\n\n",
      comment_line(source), comment_line(vehicle.rest), vehicle.speed_unit,
      vehicle.constant_force[0], vehicle.constant_force[1], vehicle.constant_force[2]);
  text += fmt::format(
      "[body]\nmass_kg = {:.6g}\ninertia_kg_m2 = {}\ncentre_of_gravity_m = {}\n"
      "centre_of_buoyancy_m = {}\nnet_buoyancy_n = {:.6g}\n\n"
      "[hydrodynamics]\nadded_mass = {}\nlinear_damping = {}\nquadratic_damping = {}\n\n"
      "[rotors]\nlag_s = {:.6g}  # commands are speeds here\n\n",
      body.mass_kg, rows_toml(body.inertia_kg_m2), numbers_toml(body.centre_of_gravity_m),
      numbers_toml(body.centre_of_buoyancy_m), body.net_buoyancy_n, rows_toml(body.added_mass),
      numbers_toml(body.linear_damping), numbers_toml(body.quadratic_damping), body.rotor_lag_s);
  for (std::size_t i = 0; i < vehicle::kThrusterCount; ++i) {
    const vehicle::Thruster& thruster = body.thrusters[i];
    text += fmt::format(
        "[thrusters.{}]\nforward = {:.6g}\nreverse = {:.6g}\nposition_m = {}\ndirection = {}\n"
        "max_speed_rps = {:.6g}\n\n",
        vehicle::thruster_names()[i], thruster.forward, thruster.reverse,
        numbers_toml(thruster.position_m),
        fmt::format("[{:.17g}, {:.17g}, {:.17g}]", thruster.direction(0), thruster.direction(1),
                    thruster.direction(2)),
        thruster.max_speed_rps);
  }
  return text + fmt::format(
                    "[hold]\ndepth_p = {:.6g}\ndepth_i = {:.6g}\ndepth_d = {:.6g}\n"
                    "pitch_p = {:.6g}\npitch_d = {:.6g}\n",
                    body.hold.depth_p, body.hold.depth_i, body.hold.depth_d, body.hold.pitch_p,
                    body.hold.pitch_d);
}

}  // namespace kelpie::format
