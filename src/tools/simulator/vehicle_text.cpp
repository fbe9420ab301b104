// SPDX-License-Identifier: Apache-2.0
#include "simulator/vehicle_text.hpp"

#include <fmt/format.h>

namespace kelpie::simulator {
namespace {

template <typename Vector>
std::string list(const Vector& values) {
  std::string text;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    text += fmt::format("{}{:.6g}", i > 0 ? ", " : "", values(i) + 0.0);
  }
  return "[" + text + "]";
}

template <typename Matrix>
std::string table(const Matrix& matrix) {
  if (Matrix(matrix.diagonal().asDiagonal()) == matrix) {
    return list(matrix.diagonal());
  }
  std::string text = "[\n";
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    text += "  " + list(matrix.row(row)) + ",\n";
  }
  return text + "]";
}

std::string rotors_text(const VehicleParameters& vehicle) {
  std::string text = fmt::format("[rotors]\ncommand = \"{}\"\nlag_s = {:.6g}\n",
                                 command_unit_name(vehicle.command_unit), vehicle.rotor_lag_s);
  if (vehicle.rotor_rate > 0.0) {
    text += fmt::format("rate = {:.6g}\n", vehicle.rotor_rate);
  }
  if (vehicle.rotor_delay_s > 0.0) {
    text += fmt::format("delay_s = {:.6g}\n", vehicle.rotor_delay_s);
  }
  return text + "\n";
}

std::string thruster_text(const Thruster& thruster, CommandUnit unit) {
  std::string text = fmt::format(
      "[thrusters.{}]\nforward = {:.6g}\nreverse = {:.6g}\nposition_m = {}\n"
      "direction = [{:.17g}, {:.17g}, {:.17g}]\n",
      thruster.name, thruster.forward, thruster.reverse, list(thruster.position_m),
      thruster.direction(0), thruster.direction(1), thruster.direction(2));
  if (thruster.dead_band > 0.0) {
    text += fmt::format("dead_band = {:.6g}\n", thruster.dead_band);
  }
  if (unit == CommandUnit::speed) {
    text += fmt::format("max_speed_rps = {:.6g}\n", thruster.max_speed_rps);
  }
  return text + "\n";
}

std::string battery_text(const BatteryParameters& battery) {
  return battery.nominal_v == 0.0
             ? ""
             : fmt::format(
                   "[battery]\nnominal_v = {:.6g}\nfull_v = {:.6g}\nempty_v = {:.6g}\n"
                   "resistance_ohm = {:.6g}\ncapacity_ah = {:.6g}\nthruster_w = {:.6g}\n"
                   "idle_w = {:.6g}\nexponent = {:.6g}\n\n",
                   battery.nominal_v, battery.full_v, battery.empty_v, battery.resistance_ohm,
                   battery.capacity_ah, battery.thruster_w, battery.idle_w, battery.exponent);
}

}  // namespace

std::string vehicle_text(const VehicleParameters& vehicle) {
  std::string text = fmt::format(
      "[body]\nmass_kg = {:.6g}\ninertia_kg_m2 = {}\ncentre_of_gravity_m = {}\n"
      "centre_of_buoyancy_m = {}\nnet_buoyancy_n = {:.6g}\n\n"
      "[hydrodynamics]\nadded_mass = {}\nlinear_damping = {}\nquadratic_damping = {}\n\n",
      vehicle.mass_kg, table(vehicle.inertia_kg_m2), list(vehicle.centre_of_gravity_m),
      list(vehicle.centre_of_buoyancy_m), vehicle.net_buoyancy_n, table(vehicle.added_mass),
      list(vehicle.linear_damping), list(vehicle.quadratic_damping));
  text += rotors_text(vehicle) + battery_text(vehicle.battery);
  for (const Thruster& thruster : vehicle.thrusters) {
    text += thruster_text(thruster, vehicle.command_unit);
  }
  const HoldGains& hold = vehicle.hold;
  text += fmt::format(
      "[hold]\ndepth_p = {:.6g}\ndepth_i = {:.6g}\ndepth_d = {:.6g}\npitch_p = {:.6g}\n"
      "pitch_d = {:.6g}\n",
      hold.depth_p, hold.depth_i, hold.depth_d, hold.pitch_p, hold.pitch_d);
  if (hold.roll_p > 0.0 || hold.roll_d > 0.0) {
    text += fmt::format("roll_p = {:.6g}\nroll_d = {:.6g}\n", hold.roll_p, hold.roll_d);
  }
  return text;
}

}  // namespace kelpie::simulator
