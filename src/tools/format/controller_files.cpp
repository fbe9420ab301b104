// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <string>

#include "format/parameters.hpp"
#include "format/simulator_fields.hpp"

namespace kelpie::format {
namespace {

constexpr const char* kHead = R"({mark} Identified by kelpie from {source}: {what}. SI.
{mark} Not identified: {rest}.
{mark} Constant forces in the log (surge, sway, heave in N, roll, pitch, yaw in N m; FRD): {forces}.
)";

std::string filled_template(const IdentifiedVehicle& vehicle, const std::string& source,
                            const char* mark, const char* text) {
  Fields fields = vehicle_fields(vehicle, source);
  fields.push_back(fmt::arg("mark", mark));
  return fmt::vformat(kHead, fields) + fmt::vformat(text, fields);
}

// Source: Robotic-Decision-Making-Lab/blue, config/bluerov2_heavy/controllers.yaml and
// hydrodynamics.cpp (M = M_RB − diag(added_mass_coeff)).
constexpr const char* kBlue =
    R"(# For blue (Robotic-Decision-Making-Lab): parameters of the controller. Body frame FRD about the
# origin of the measured velocities. added_mass_coeff and damping coefficients are derivatives and
# negative (kg, kg m^2; N s/m, N m s/rad; N s^2/m^2, N m s^2/rad^2); weight and buoyancy in N.
# tcm: force and moment per newton of each thruster (columns), rows surge to yaw.
# blue simulates in Gazebo: paste gazebo.sdf there.
ismc:
  ros__parameters:
    mass: {mass}
    buoyancy: {buoyant_force}
    weight: {weight}
    inertia_tensor_coeff: [{inertia_list}]
    added_mass_coeff: [{minus_added_list}]
    linear_damping_coeff: [{minus_linear_list}]
    quadratic_damping_coeff: [{minus_quadratic_list}]
    center_of_gravity: [{gravity_list}]
    center_of_buoyancy: [{buoyancy_list}]
    num_thrusters: {thruster_count}
    tcm: [
{arms_list}    ]
)";

// Source: clydemcqueen/orca4, orca_base/README.md and orca_shared/model.hpp.
constexpr const char* kOrca =
    R"(# For orca4: the controller's model of motion, which knows mass, volume and quadratic drag, and
# neither added mass nor linear drag. mdl_drag_coef: positive, of 0.5 rho area v^2 with the areas of a
# BlueROV2 (0.457 m x 0.338 m x 0.254 m); linear drag is folded in for the speeds of the log.
# mdl_drag_partial_const_yaw times the density: N m s^2/rad^2. orca4 simulates in Gazebo: paste
# gazebo.sdf there.
base_controller:
  ros__parameters:
    mdl_mass: {mass}
    mdl_volume: {orca_volume}
    mdl_fluid_density: {orca_water}
    mdl_drag_coef_x: {orca_x}
    mdl_drag_coef_y: {orca_y}
    mdl_drag_coef_z: {orca_z}
    mdl_drag_partial_const_yaw: {orca_yaw}
)";

// Source: cybergalactic/MSS (Fossen 2021, Handbook, 2nd edition, eqs. 6.1, 6.43, 8.1).
constexpr const char* kMss =
    R"(% For MSS (Fossen). Body frame FRD about CO, the origin of the measured velocities; world NED.
% MA > 0 (= -diag of Xudot, Yvdot, ...), D > 0 (= -Xu, ...), Dn > 0 (= -X|u|u, ...):
%   (MRB + MA) nudot + (CRB + CA) nu + (D + diag(Dn .* abs(nu))) nu + g(eta) = T f
% f: thrusts in N, T: force and moment per newton of each thruster. W, B in N.
m = {mass};
Ig = [
{inertia_m}];  % about CG
r_g = [{gravity}]';
r_b = [{buoyancy}]';
W = {weight};
B = {buoyant_force};
MA = [
{added_m}];
D = diag([{linear}]);
Dn = [{quadratic}]';
T = [
{arms_m}];
Mg = [m * eye(3) zeros(3); zeros(3) Ig];
H = Hmtrx(r_g);
MRB = H' * Mg * H;
M = MRB + MA;
)";

// Source: cybergalactic/PythonVehicleSimulator, lib/gnc.py (Hmtrx, m2c) and lib/mainLoop.py.
constexpr const char* kPython =
    R"(# For the Python Vehicle Simulator (Fossen): into __init__ of a vehicle. Body frame FRD about CO,
# the origin of the measured velocities; world NED. MA > 0 (= -diag of Xudot, Yvdot, ...), D > 0,
# Dn > 0; W, B in N; T: force and moment per newton of each thruster. In dynamics():
#   nu_dot = Minv @ (T @ thrusts - m2c(M, nu) @ nu - (D + np.diag(Dn * abs(nu))) @ nu - g)
import numpy as np
from python_vehicle_simulator.lib.gnc import Hmtrx

m = {mass}
Ig = np.array([
{inertia_py}])  # about CG
r_g = np.array([{gravity_list}])
r_b = np.array([{buoyancy_list}])
W = {weight}
B = {buoyant_force}
MA = np.array([
{added_py}])
D = np.diag([{linear_list}])
Dn = np.array([{quadratic_list}])
T = np.array([
{arms_py}])
H = Hmtrx(r_g)
MRB = H.T @ np.block([[m * np.eye(3), np.zeros((3, 3))], [np.zeros((3, 3)), Ig]]) @ H
M = MRB + MA
Minv = np.linalg.inv(M)
)";

// Source: ArduPilot, libraries/SITL/SIM_Submarine.{h,cpp}.
constexpr const char* kArduPilot =
    R"(# For ArduPilot's SITL (Submarine). Of what was identified only net buoyancy is a parameter, in N,
# positive: rises. Mass, size, thrust and drag (coefficients of a sphere) stand in SIM_Submarine.h, and
# there is no added mass. For the identified vehicle let SITL drive Gazebo with gazebo.sdf.
SIM_BUOYANCY {net_buoyancy}
)";

}  // namespace

std::string blue_yaml(const IdentifiedVehicle& vehicle, const std::string& source) {
  return filled_template(vehicle, source, "#", kBlue);
}

std::string orca4_yaml(const IdentifiedVehicle& vehicle, const std::string& source) {
  return filled_template(vehicle, source, "#", kOrca);
}

std::string mss_m(const IdentifiedVehicle& vehicle, const std::string& source) {
  return filled_template(vehicle, source, "%", kMss);
}

std::string python_vehicle(const IdentifiedVehicle& vehicle, const std::string& source) {
  return filled_template(vehicle, source, "#", kPython);
}

std::string ardupilot_parm(const IdentifiedVehicle& vehicle, const std::string& source) {
  return filled_template(vehicle, source, "#", kArduPilot);
}

}  // namespace kelpie::format
