// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "format/identified_vehicle.hpp"

namespace kelpie::format {

// Contents of the files that `kelpie identify` writes: docs/howto/identify.md.

/// "given", "identified", "at its bound" or "not told by the log".
const char* state_word(ParameterState state);

/// Half of the 90 % interval of a parameter.
double half_width90(const FittedParameter& parameter);

/// The unit of a parameter of a fit: SI with a scale, else divided by kg.
std::string parameter_unit(const study::Identification& found, std::size_t place);

/// Where forces have their unit from, in words.
std::string scale_text(const study::Identification& found);

/// The parameters that the log tells.
std::vector<std::size_t> identified_places(const study::Identification& found);

inline constexpr const char* kParametersFormat = "kelpie-parameters";  ///< `format` of both
inline constexpr int kParametersVersion = 1;                           ///< `version` of both

/// Values, errors, intervals and correlations of a fit as YAML.
std::string parameters_yaml(const study::Identification& found, Frame frame);

/// The same as JSON: lists in place of maps by name, null for a number that isn't finite. Ends in a
/// newline.
std::string parameters_json(const study::Identification& found, Frame frame);

/// A vehicle file (docs/reference/simulator.md). Requires `has_slots`.
std::string vehicle_toml(const IdentifiedVehicle& vehicle, const std::string& source);

/// A model of Gazebo (gz-sim 8 and later): inertial with fluid_added_mass, plugins Hydrodynamics
/// and Thruster. FLU.
std::string gazebo_sdf(const IdentifiedVehicle& vehicle, const std::string& source);

/// The same for Gazebo without <fluid_added_mass>: added mass as derivatives of the plugin
/// Hydrodynamics. FLU, all coefficients negative.
std::string gazebo_plugin_sdf(const IdentifiedVehicle& vehicle, const std::string& source);

/// Hydrodynamic model and thrusters for UUV Simulator and Plankton, as xacro. Positions FLU;
/// added mass FRD, positive; damping negative.
std::string uuv_xacro(const IdentifiedVehicle& vehicle, const std::string& source);

/// Mass properties and thrusters for Stonefish; added mass and drag, which Stonefish takes from the
/// geometry, in comments. FRD.
std::string stonefish_xml(const IdentifiedVehicle& vehicle, const std::string& source);

/// Matrices for Fossen's MSS (MATLAB, Octave): FRD, all positive.
std::string mss_m(const IdentifiedVehicle& vehicle, const std::string& source);

/// The same for the Python Vehicle Simulator.
std::string python_vehicle(const IdentifiedVehicle& vehicle, const std::string& source);

}  // namespace kelpie::format
