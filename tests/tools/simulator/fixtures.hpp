// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "kelpie/core/random.hpp"
#include "simulator/dynamics.hpp"
#include "simulator/integrator.hpp"
#include "simulator/scenario_file.hpp"

namespace kelpie::testing {

inline std::filesystem::path source_file(const std::string& name) {
  return std::filesystem::path(KELPIE_SOURCE_DIR) / name;
}

inline simulator::VehicleParameters dagon() {
  return simulator::read_vehicle(source_file("vehicles/dagon.toml"));
}

/// Dagon without what takes energy away, floating neither up nor down.
inline simulator::VehicleParameters lossless_dagon() {
  simulator::VehicleParameters vehicle = dagon();
  vehicle.linear_damping.setZero();
  vehicle.quadratic_damping.setZero();
  vehicle.net_buoyancy_n = 0.0;
  return vehicle;
}

inline simulator::Plant nominal(const simulator::VehicleParameters& vehicle) {
  return simulator::make_plant(vehicle, simulator::Configuration{});
}

template <int size>
Eigen::Matrix<double, size, 1> random_vector(RandomStream& stream, double scale) {
  Eigen::Matrix<double, size, 1> values;
  for (double& value : values) {
    value = stream.uniform(-scale, scale);
  }
  return values;
}

/// A vehicle whose added mass couples every axis with every other.
inline simulator::VehicleParameters coupled_vehicle(RandomStream& stream) {
  simulator::VehicleParameters vehicle = dagon();
  const simulator::Vector6 scale = vehicle.added_mass.diagonal().cwiseSqrt();
  for (int term = 0; term < 6; ++term) {
    const simulator::Vector6 direction = random_vector<6>(stream, 0.6).cwiseProduct(scale);
    vehicle.added_mass += direction * direction.transpose();
  }
  vehicle.centre_of_gravity_m = random_vector<3>(stream, 0.1);
  return vehicle;
}

inline simulator::State random_state(RandomStream& stream) {
  simulator::State state;
  state.attitude = Eigen::Quaterniond(random_vector<4>(stream, 1.0)).normalized();
  state.velocity = random_vector<6>(stream, 0.5);
  return state;
}

/// Kinetic and potential energy; weight and buoyancy are forces along z, down.
inline double energy(const simulator::Plant& plant, const simulator::State& state) {
  const Eigen::Vector3d arm = state.attitude * plant.weight_moment_nm;
  return 0.5 * state.velocity.dot(plant.mass * state.velocity) -
         plant.net_weight_n * state.position_m.z() - arm.z();
}

inline simulator::State after(const simulator::Dynamics& dynamics, simulator::State state,
                              double duration_s, double step_s,
                              const simulator::RotorDrive& drive = {}) {
  for (long step = std::lround(duration_s / step_s); step > 0; --step) {
    state = simulator::rk4_step(dynamics, state, drive, step_s);
  }
  return state;
}

}  // namespace kelpie::testing
