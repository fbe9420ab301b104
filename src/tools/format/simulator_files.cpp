// SPDX-License-Identifier: Apache-2.0
// The files of simulators as templates: {name} is replaced by a value, with six digits.
#include <fmt/args.h>
#include <fmt/format.h>

#include <array>
#include <numbers>
#include <string>

#include "format/parameters.hpp"
#include "vehicle/parameters.hpp"
#include "vehicle/vehicle_text.hpp"

namespace kelpie::format {
namespace {

using Fields = fmt::dynamic_format_arg_store<fmt::format_context>;

constexpr double kFreshWater = 1000.0;      // kg/m³
constexpr double kUuvSeaWater = 1028.0;     // kg/m³, the default of UUV Simulator
constexpr double kPropellerDiameter = 0.1;  // m; only its product with the coefficient counts
constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kPerRadians = 1.0 / (4.0 * std::numbers::pi * std::numbers::pi);  // of (rev/s)²

void add(Fields& fields, const char* name, const std::string& value) {
  fields.push_back(fmt::arg(name, value));
}

void add(Fields& fields, const char* name, double value) {
  add(fields, name, fmt::format("{:.6g}", value + 0.0));
}

template <typename Vector>
std::string numbers(const Vector& values, const char* separator = " ") {
  std::string text;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    text += fmt::format("{}{:.6g}", i > 0 ? separator : "", values(i) + 0.0);
  }
  return text;
}

// Every row of a matrix as a line between `before` and `after`.
template <typename Matrix>
std::string rows(const Matrix& matrix, const char* before, const char* separator,
                 const char* after) {
  std::string text;
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    text += before + numbers(matrix.row(row), separator) + after;
  }
  return text;
}

// FRD to FLU.
vehicle::Matrix6 mirrored(const vehicle::Matrix6& matrix) {
  const vehicle::Vector6 sign = (vehicle::Vector6() << 1, -1, -1, 1, -1, -1).finished();
  return sign.asDiagonal() * matrix * sign.asDiagonal();
}

Eigen::Vector3d mirrored(const Eigen::Vector3d& vector) {
  return {vector(0), -vector(1), -vector(2)};
}

std::string without_controls(std::string text) {
  for (char& letter : text) {
    letter = static_cast<unsigned char>(letter) < ' ' ? '?' : letter;
  }
  return text;
}

// Text in an element or a quoted attribute.
std::string xml_text(const std::string& text) {
  std::string safe;
  for (const char letter : without_controls(text)) {
    switch (letter) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += letter;
    }
  }
  return safe;
}

// Text in a comment, which holds no two dashes in a row.
std::string comment_text(const std::string& text) {
  std::string safe;
  for (const char letter : without_controls(text)) {
    safe += letter == '-' && !safe.empty() && safe.back() == '-' ? " -" : std::string(1, letter);
  }
  return safe;
}

// The upper triangle, named as in SDFormat: xx, xy, … rr.
std::string added_mass_sdf(const vehicle::Matrix6& added) {
  constexpr std::array kAxes{'x', 'y', 'z', 'p', 'q', 'r'};
  std::string text;
  for (std::size_t row = 0; row < kAxes.size(); ++row) {
    for (std::size_t column = row; column < kAxes.size(); ++column) {
      text += fmt::format(
          "          <{0}{1}>{2:.6g}</{0}{1}>\n", kAxes[row], kAxes[column],
          added(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) + 0.0);
    }
  }
  return text;
}

std::string damping_sdf(const vehicle::VehicleParameters& body) {
  constexpr std::array kLinear{"xU", "yV", "zW", "kP", "mQ", "nR"};
  constexpr std::array kQuadratic{"xUabsU", "yVabsV", "zWabsW", "kPabsP", "mQabsQ", "nRabsR"};
  std::string text;
  for (std::size_t i = 0; i < kLinear.size(); ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    text += fmt::format("      <{0}>{1:.6g}</{0}>\n      <{2}>{3:.6g}</{2}>\n", kLinear[i],
                        -body.linear_damping(axis) + 0.0, kQuadratic[i],
                        -body.quadratic_damping(axis) + 0.0);
  }
  return text;
}

Fields thruster_fields(const IdentifiedVehicle& vehicle, std::size_t index) {
  Fields fields;
  const PlanarThruster& thruster = vehicle.thrusters[index];
  // Of its line of action, the place nearest to the origin.
  const Eigen::Vector3d place(thruster.arm_m * std::sin(thruster.angle_rad),
                              -thruster.arm_m * std::cos(thruster.angle_rad), 0.0);
  const double greatest = vehicle.greatest_rps[index];
  const bool told = vehicle.reverse_told[index];
  add(fields, "name", xml_text(thruster.name));
  add(fields, "name_comment", comment_text(thruster.name));
  add(fields, "place", numbers(place));
  add(fields, "place_flu", numbers(mirrored(place)));
  add(fields, "angle", thruster.angle_rad);
  add(fields, "angle_flu", -thruster.angle_rad);
  add(fields, "forward", thruster.forward * kPerRadians);
  add(fields, "reverse", thruster.reverse * kPerRadians);
  add(fields, "greatest", greatest * kTurn);
  add(fields, "most_thrust", thruster.forward * greatest * greatest);
  add(fields, "least_thrust", -thruster.reverse * greatest * greatest);
  add(fields, "coefficient",
      thruster.forward * kPerRadians /
          (kFreshWater * kPropellerDiameter * kPropellerDiameter * kPropellerDiameter *
           kPropellerDiameter));
  add(fields, "was", told ? "identified" : "taken as forwards, it never ran so");
  add(fields, "both",
      told ? "both ways identified" : "in reverse taken as forwards, it never ran so");
  add(fields, "note", told ? "" : "    <!-- in reverse taken as forwards, it never ran so -->\n");
  const bool lag = vehicle.body.rotor_lag_s > 0.0;
  const std::string seconds = fmt::format("{:.6g}", vehicle.body.rotor_lag_s);
  add(fields, "rotor_uuv",
      lag ? "<type>FirstOrder</type><timeConstant>" + seconds + "</timeConstant>"
          : "<type>ZeroOrder</type>");
  add(fields, "rotor_stonefish",
      lag ? "<rotor_dynamics type=\"first_order\">\n      <time_constant value=\"" + seconds +
                "\"/>\n    </rotor_dynamics>"
          : "<rotor_dynamics type=\"zero_order\"/>");
  return fields;
}

Fields fields_of(const IdentifiedVehicle& vehicle, const std::string& source) {
  const vehicle::VehicleParameters& body = vehicle.body;
  const vehicle::Vector6& linear = body.linear_damping;
  const vehicle::Vector6& quadratic = body.quadratic_damping;
  const double displaced = body.mass_kg + body.net_buoyancy_n / vehicle::kGravity;
  Fields fields;
  add(fields, "source", comment_text(source));
  add(fields, "rest", comment_text(vehicle.rest));
  add(fields, "speeds", comment_text(vehicle.speed_unit));
  add(fields, "forces",
      fmt::format("{:.3g} N, {:.3g} N, {:.3g} N m", vehicle.constant_force[0],
                  vehicle.constant_force[1], vehicle.constant_force[2]));
  add(fields, "mass", body.mass_kg);
  add(fields, "volume", displaced / kFreshWater);
  add(fields, "sea_volume", displaced / kUuvSeaWater);
  add(fields, "inertia", numbers(body.inertia_kg_m2.diagonal()));
  add(fields, "ixx", body.inertia_kg_m2(0, 0));
  add(fields, "iyy", body.inertia_kg_m2(1, 1));
  add(fields, "izz", body.inertia_kg_m2(2, 2));
  add(fields, "ixy_flu", -body.inertia_kg_m2(0, 1));
  add(fields, "ixz_flu", -body.inertia_kg_m2(0, 2));
  add(fields, "iyz", body.inertia_kg_m2(1, 2));
  add(fields, "gravity", numbers(body.centre_of_gravity_m));
  add(fields, "gravity_flu", numbers(mirrored(body.centre_of_gravity_m)));
  add(fields, "buoyancy_flu",
      numbers(mirrored(Eigen::Vector3d(body.centre_of_buoyancy_m - body.centre_of_gravity_m))));
  add(fields, "added_sdf", added_mass_sdf(mirrored(body.added_mass)));
  add(fields, "added_rows_flu", rows(mirrored(body.added_mass), "          ", " ", "\n"));
  add(fields, "surge_added", body.added_mass(0, 0));
  add(fields, "sway_added", body.added_mass(1, 1));
  add(fields, "yaw_added", body.added_mass(5, 5));
  add(fields, "damping_sdf", damping_sdf(body));
  add(fields, "minus_linear", numbers((-linear).eval()));
  add(fields, "minus_quadratic", numbers((-quadratic).eval()));
  add(fields, "plane_linear", numbers(Eigen::Vector3d(linear(0), linear(1), linear(5))));
  add(fields, "plane_quadratic",
      numbers(Eigen::Vector3d(quadratic(0), quadratic(1), quadratic(5))));
  return fields;
}

constexpr const char* kXmlHead = R"(<?xml version="1.0"?>
<!-- Identified by kelpie from {source}: surge, sway, yaw and thrusters in the plane. SI. -->
<!-- Not identified: {rest}. Thrusters' speeds {speeds}. -->
<!-- Constant forces in the log (surge, sway, yaw; FRD): {forces}; not in this file -->
)";

// A file of XML: head and body of the vehicle, the thrusters, the end.
std::string xml_file(const IdentifiedVehicle& vehicle, const std::string& source, const char* body,
                     const char* thruster, const char* end) {
  const Fields fields = fields_of(vehicle, source);
  std::string text = fmt::vformat(kXmlHead, fields) + fmt::vformat(body, fields);
  for (std::size_t i = 0; i < vehicle.thrusters.size(); ++i) {
    text += fmt::vformat(thruster, thruster_fields(vehicle, i));
  }
  return text + end;
}

constexpr const char* kGazebo = R"(<sdf version="1.10">
  <model name="identified">
    <link name="base_link">
      <inertial>
        <pose>{gravity_flu} 0 0 0</pose>
        <mass>{mass}</mass>
        <inertia>
          <ixx>{ixx}</ixx>
          <iyy>{iyy}</iyy>
          <izz>{izz}</izz>
          <ixy>{ixy_flu}</ixy>
          <ixz>{ixz_flu}</ixz>
          <iyz>{iyz}</iyz>
        </inertia>
        <fluid_added_mass>
{added_sdf}        </fluid_added_mass>
      </inertial>
    </link>
    <!-- buoyancy: the world's gz::sim::systems::Buoyancy, with a volume of {volume} m^3 -->
    <plugin filename="gz-sim-hydrodynamics-system" name="gz::sim::systems::Hydrodynamics">
      <link_name>base_link</link_name>
{damping_sdf}      <disable_added_mass>true</disable_added_mass>
      <disable_coriolis>true</disable_coriolis>
    </plugin>
)";

constexpr const char* kGazeboThruster = R"(    <link name="{name}_propeller">
      <pose>{place_flu} 0 0 {angle_flu}</pose>
      <inertial>
        <mass>0.001</mass>
        <inertia><ixx>1e-6</ixx><iyy>1e-6</iyy><izz>1e-6</izz></inertia>
      </inertial>
    </link>
    <joint name="{name}_joint" type="revolute">
      <parent>base_link</parent>
      <child>{name}_propeller</child>
      <axis>
        <xyz>1 0 0</xyz>
        <limit><lower>-1e16</lower><upper>1e16</upper></limit>
      </axis>
    </joint>
    <!-- in reverse {reverse} N/(rad/s)^2 was {was}, forwards {forward}: this plugin has one coefficient; the limits of the thrust are those of the log -->
    <plugin filename="gz-sim-thruster-system" name="gz::sim::systems::Thruster">
      <joint_name>{name}_joint</joint_name>
      <fluid_density>1000</fluid_density>
      <propeller_diameter>0.1</propeller_diameter>
      <thrust_coefficient>{coefficient}</thrust_coefficient>
      <max_thrust_cmd>{most_thrust}</max_thrust_cmd>
      <min_thrust_cmd>{least_thrust}</min_thrust_cmd>
      <velocity_control>true</velocity_control>
    </plugin>
)";

constexpr const char* kStonefish =
    R"(<!-- Stonefish takes added mass and drag from the body's geometry and no coefficients: give base_link a mesh (and its <propeller> to each thruster), then compare with what was identified -->
<!-- identified added mass (surge, sway, yaw): {surge_added} kg, {sway_added} kg, {yaw_added} kg m^2 -->
<!-- identified linear damping (surge, sway, yaw): {plane_linear}; quadratic: {plane_quadratic} -->
<robot name="Identified" fixed="false" self_collisions="false">
  <base_link name="Vehicle" type="model" physics="submerged" buoyant="true">
    <mass value="{mass}"/>
    <inertia xyz="{inertia}"/>
    <cg xyz="{gravity}" rpy="0.0 0.0 0.0"/>
  </base_link>
)";

constexpr const char* kStonefishThruster = R"(  <actuator name="{name}" type="thruster">
    <specs max_setpoint="{greatest}" inverted_setpoint="false"/>
    {rotor_stonefish}
{note}    <thrust_model type="deadband">
      <thrust_coeff forward="{forward}" reverse="{reverse}"/>
      <deadband lower="0.0" upper="0.0"/>
    </thrust_model>
    <origin xyz="{place}" rpy="0.0 0.0 {angle}"/>
    <link name="Vehicle"/>
  </actuator>
)";

constexpr const char* kUuv = R"(<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="identified_hydro_model" params="namespace">
    <link name="${{namespace}}/base_link">
      <neutrally_buoyant>0</neutrally_buoyant>
      <volume>{sea_volume}</volume>
      <center_of_buoyancy>{buoyancy_flu}</center_of_buoyancy>
      <hydrodynamic_model>
        <type>fossen</type>
        <added_mass>
{added_rows_flu}        </added_mass>
        <linear_damping>
          {minus_linear}
        </linear_damping>
        <quadratic_damping>
          {minus_quadratic}
        </quadratic_damping>
      </hydrodynamic_model>
    </link>
  </xacro:macro>
  <!-- mass of base_link: {mass} kg; inertia about its centre of gravity (ixx, iyy, izz): {inertia} -->
  <!-- blocks for thruster_module_first_order_… of thruster_snippets.xacro -->
  <xacro:property name="identified_thrusters">
)";

constexpr const char* kUuvThruster = R"(    <!-- {name_comment}: N/(rad/s)^2, {both} -->
    <thruster name="{name}">
      <origin xyz="{place_flu}" rpy="0 0 {angle_flu}"/>
      <dynamics>{rotor_uuv}</dynamics>
      <conversion>
        <type>Bessa</type>
        <rotorConstantL>{reverse}</rotorConstantL>
        <rotorConstantR>{forward}</rotorConstantR>
        <deltaL>0</deltaL>
        <deltaR>0</deltaR>
      </conversion>
    </thruster>
)";

}  // namespace

std::string gazebo_sdf(const IdentifiedVehicle& vehicle, const std::string& source) {
  return xml_file(vehicle, source, kGazebo, kGazeboThruster, "  </model>\n</sdf>\n");
}

std::string uuv_xacro(const IdentifiedVehicle& vehicle, const std::string& source) {
  return xml_file(vehicle, source, kUuv, kUuvThruster, "  </xacro:property>\n</robot>\n");
}

std::string stonefish_xml(const IdentifiedVehicle& vehicle, const std::string& source) {
  return xml_file(vehicle, source, kStonefish, kStonefishThruster, "</robot>\n");
}

std::string vehicle_toml(const IdentifiedVehicle& vehicle, const std::string& source) {
  return fmt::format(
             "# Identified by `kelpie identify` from {}.\n"
             "# Surge, sway, yaw and the lateral thrusters are identified; {}.\n"
             "# Commands are speeds of thrusters in rev/s, {}. Constant forces ({:.3g} N, {:.3g} "
             "N, "
             "{:.3g} N m) aren't part of a vehicle file.\n\n",
             without_controls(source), without_controls(vehicle.rest), vehicle.speed_unit,
             vehicle.constant_force[0], vehicle.constant_force[1], vehicle.constant_force[2]) +
         vehicle::vehicle_text(vehicle.body);
}

}  // namespace kelpie::format
