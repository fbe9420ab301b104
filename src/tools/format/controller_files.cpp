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

}  // namespace

std::string mss_m(const IdentifiedVehicle& vehicle, const std::string& source) {
  return filled_template(vehicle, source, "%", kMss);
}

std::string python_vehicle(const IdentifiedVehicle& vehicle, const std::string& source) {
  return filled_template(vehicle, source, "#", kPython);
}

}  // namespace kelpie::format
