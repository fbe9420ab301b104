// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kelpie/motion/frame.hpp"
#include "study/identification.hpp"
#include "vehicle/parameters.hpp"

namespace kelpie::format {

/// An identified vehicle in six degrees of freedom, for simulators: SI, frame FRD, about the origin
/// of the measured velocities. Quantities outside the plane come from a base vehicle or are
/// assumed.
struct IdentifiedVehicle {
  vehicle::VehicleParameters body{};  ///< thrusters only where `has_slots`
  /// As fitted; thrusts per (rev/s)².
  std::vector<PlanarThruster> thrusters{};
  std::vector<double> greatest_rps{};  ///< of thrusters
  std::vector<bool> reverse_told{};    ///< of thrusters; else reverse equals forward
  PlanarVector constant_force{};
  std::string rest{};        ///< source of heave, roll, pitch and the split of masses
  std::string speed_unit{};  ///< "rev/s", and whether the log said so
  bool has_slots = false;    ///< two thrusters along surge, one along sway: body.thrusters are set
};

/// Requires an identification with a scale. `base`: the file of --vehicle, or none. Throws
/// InputError on a thruster's unit other than a speed, and on a mass above the identified inertia.
IdentifiedVehicle identified_vehicle(const study::Identification& found, Frame frame,
                                     const std::optional<vehicle::VehicleParameters>& base,
                                     const std::string& base_file);

}  // namespace kelpie::format
