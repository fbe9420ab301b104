// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <string>

#include "format/parameters.hpp"
#include "format/parameters_xml.hpp"

namespace kelpie::format {
namespace {

constexpr double kSeaDensity = 1028.0;  // UUV Simulator's default, kg/m³

std::string rows_xacro(const vehicle::Matrix6& matrix) {
  std::string text;
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    text += "          " + xml_numbers(matrix.row(row).transpose()) + "\n";
  }
  return text;
}

std::string thruster_xacro(const IdentifiedVehicle& vehicle, std::size_t index) {
  const PlanarThruster& thruster = vehicle.thrusters[index];
  const std::string lag =
      vehicle.body.rotor_lag_s > 0.0
          ? fmt::format("<type>FirstOrder</type><timeConstant>{:.6g}</timeConstant>",
                        vehicle.body.rotor_lag_s)
          : "<type>ZeroOrder</type>";
  std::string text = xml_comment(
      fmt::format("{}: N/(rad/s)^2, {}", thruster.name,
                  vehicle.reverse_told[index] ? "both ways identified"
                                              : "in reverse taken as forwards, it never ran so"),
      4);
  return text +
         fmt::format(
             "    <thruster name=\"{}\">\n      <origin xyz=\"{}\" rpy=\"0 0 {:.6g}\"/>\n"
             "      <dynamics>{}</dynamics>\n      <conversion>\n        <type>Bessa</type>\n"
             "        <rotorConstantL>{:.6g}</rotorConstantL>\n"
             "        <rotorConstantR>{:.6g}</rotorConstantR>\n        <deltaL>0</deltaL>\n"
             "        <deltaR>0</deltaR>\n      </conversion>\n    </thruster>\n",
             xml_text(thruster.name), xml_numbers(mirrored(thruster_place(thruster))),
             -thruster.angle_rad + 0.0, lag, thruster.reverse * kPerRadians,
             thruster.forward * kPerRadians);
}

}  // namespace

std::string uuv_xacro(const IdentifiedVehicle& vehicle, const std::string& source) {
  const vehicle::VehicleParameters& body = vehicle.body;
  const Eigen::Vector3d from_gravity =
      mirrored(Eigen::Vector3d(body.centre_of_buoyancy_m - body.centre_of_gravity_m));
  std::string text = "<?xml version=\"1.0\"?>\n" + xml_head(vehicle, source) +
                     "<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\">\n"
                     "  <xacro:macro name=\"identified_hydro_model\" params=\"namespace\">\n"
                     "    <link name=\"${namespace}/base_link\">\n      "
                     "<neutrally_buoyant>0</neutrally_buoyant>\n";
  text += fmt::format(
      "      <volume>{:.6g}</volume>\n      <center_of_buoyancy>{}</center_of_buoyancy>\n"
      "      <hydrodynamic_model>\n        <type>fossen</type>\n        <added_mass>\n{}"
      "        </added_mass>\n        <linear_damping>\n          {}\n        </linear_damping>\n"
      "        <quadratic_damping>\n          {}\n        </quadratic_damping>\n"
      "      </hydrodynamic_model>\n    </link>\n  </xacro:macro>\n",
      (body.mass_kg + body.net_buoyancy_n / vehicle::kGravity) / kSeaDensity,
      xml_numbers(from_gravity), rows_xacro(mirrored(body.added_mass)),
      xml_numbers(-body.linear_damping), xml_numbers(-body.quadratic_damping));
  text +=
      xml_comment(fmt::format("mass of base_link: {:.6g} kg; inertia about its centre of gravity "
                              "(ixx, iyy, izz): {}",
                              body.mass_kg, xml_numbers(body.inertia_kg_m2.diagonal())),
                  2);
  text += xml_comment("blocks for thruster_module_first_order_… of thruster_snippets.xacro", 2) +
          "  <xacro:property name=\"identified_thrusters\">\n";
  for (std::size_t i = 0; i < vehicle.thrusters.size(); ++i) {
    text += thruster_xacro(vehicle, i);
  }
  return text + "  </xacro:property>\n</robot>\n";
}

}  // namespace kelpie::format
