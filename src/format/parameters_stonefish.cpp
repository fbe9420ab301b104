// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <string>

#include "format/parameters.hpp"
#include "format/parameters_xml.hpp"

namespace kelpie::format {
namespace {

std::string thruster_stonefish(const IdentifiedVehicle& vehicle, std::size_t index) {
  const PlanarThruster& thruster = vehicle.thrusters[index];
  const std::string rotor = vehicle.body.rotor_lag_s > 0.0
                                ? fmt::format(
                                      "<rotor_dynamics type=\"first_order\">\n      <time_constant "
                                      "value=\"{:.6g}\"/>\n    </rotor_dynamics>",
                                      vehicle.body.rotor_lag_s)
                                : "<rotor_dynamics type=\"zero_order\"/>";
  const std::string note = vehicle.reverse_told[index]
                               ? ""
                               : xml_comment("in reverse taken as forwards, it never ran so", 4);
  return fmt::format(
      "  <actuator name=\"{}\" type=\"thruster\">\n"
      "    <specs max_setpoint=\"{:.6g}\" inverted_setpoint=\"false\"/>\n    {}\n{}"
      "    <thrust_model type=\"deadband\">\n"
      "      <thrust_coeff forward=\"{:.6g}\" reverse=\"{:.6g}\"/>\n"
      "      <deadband lower=\"0.0\" upper=\"0.0\"/>\n    </thrust_model>\n"
      "    <origin xyz=\"{}\" rpy=\"0.0 0.0 {:.6g}\"/>\n    <link name=\"Vehicle\"/>\n"
      "  </actuator>\n",
      xml_text(thruster.name), vehicle.greatest_rps[index] * 2.0 * std::numbers::pi, rotor, note,
      thruster.forward * kPerRadians, thruster.reverse * kPerRadians,
      xml_numbers(thruster_place(thruster)), thruster.angle_rad + 0.0);
}

}  // namespace

std::string stonefish_xml(const IdentifiedVehicle& vehicle, const std::string& source) {
  const vehicle::VehicleParameters& body = vehicle.body;
  std::string text = "<?xml version=\"1.0\"?>\n" + xml_head(vehicle, source);
  text += xml_comment(
      "Stonefish takes added mass and drag from the body's geometry and no coefficients: give "
      "base_link a mesh (and its <propeller> to each thruster), then compare with what was "
      "identified");
  text +=
      xml_comment(fmt::format("identified added mass (surge, sway, yaw): {:.6g} kg, {:.6g} kg, "
                              "{:.6g} kg m^2",
                              body.added_mass(0, 0), body.added_mass(1, 1), body.added_mass(5, 5)));
  text +=
      xml_comment("identified linear damping (surge, sway, yaw): " +
                  xml_numbers(Eigen::Vector3d(body.linear_damping(0), body.linear_damping(1),
                                              body.linear_damping(5))) +
                  "; quadratic: " +
                  xml_numbers(Eigen::Vector3d(body.quadratic_damping(0), body.quadratic_damping(1),
                                              body.quadratic_damping(5))));
  text += fmt::format(
      "<robot name=\"Identified\" fixed=\"false\" self_collisions=\"false\">\n"
      "  <base_link name=\"Vehicle\" type=\"model\" physics=\"submerged\" buoyant=\"true\">\n"
      "    <mass value=\"{:.6g}\"/>\n    <inertia xyz=\"{}\"/>\n"
      "    <cg xyz=\"{}\" rpy=\"0.0 0.0 0.0\"/>\n  </base_link>\n",
      body.mass_kg, xml_numbers(body.inertia_kg_m2.diagonal()),
      xml_numbers(body.centre_of_gravity_m));
  for (std::size_t i = 0; i < vehicle.thrusters.size(); ++i) {
    text += thruster_stonefish(vehicle, i);
  }
  return text + "</robot>\n";
}

}  // namespace kelpie::format
