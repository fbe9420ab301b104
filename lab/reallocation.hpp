// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "kelpie/vehicle/diagnosis.hpp"
#include "lab/controllers.hpp"

namespace kelpie::lab {

/// Commands for forces: by the nominal vehicle until a Diagnosis has found that a thruster has lost
/// thrust, then by Authority::allocate() for what is left.
class Reallocation {
 public:
  explicit Reallocation(NominalModel nominal) : nominal_(std::move(nominal)) {}

  /// Asks a diagnosis of inputs u, v, r and three rotor speeds, now and then; once per period.
  /// Returns the force of `rotors_rps` that has just been found to be missing, else 0.
  Eigen::Vector3d look(const Diagnosis* diagnosis, const Eigen::Vector3d& rotors_rps);

  /// Rotor speeds for forces, as NominalModel::allocate().
  Eigen::Vector3d allocate(const Eigen::Vector3d& forces) const;
  /// Forces of rotor speeds, of damaged thrusters what is left.
  Eigen::Vector3d forces(const Eigen::Vector3d& speeds_rps) const;

 private:
  NominalModel nominal_;
  std::optional<Authority> authority_;  ///< of the damaged vehicle
  Eigen::Vector3d shares_ = Eigen::Vector3d::Ones();
  std::size_t periods_ = 0;
};

}  // namespace kelpie::lab
