// SPDX-License-Identifier: Apache-2.0
#include <fmt/args.h>
#include <fmt/format.h>

#include <string>

#include "core/text.hpp"
#include "format/parameters.hpp"
#include "format/simulator_fields.hpp"
#include "simulator/parameters.hpp"
#include "simulator/vehicle_text.hpp"

namespace kelpie::format {
namespace {

constexpr const char* kXmlHead = R"(<?xml version="1.0"?>
<!-- Identified by kelpie from {source}: {what}. SI. -->
<!-- Not identified: {rest}. Thrusters' speeds {speeds}. -->
<!-- Constant forces in the log (surge, sway, heave in N, roll, pitch, yaw in N m; FRD): {forces}; not in this file -->
)";

constexpr const char* kGazeboInertia = R"(      <inertial>
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
)";

// A file of XML: head and body of the vehicle, the thrusters, the end.
std::string xml_file(const IdentifiedVehicle& vehicle, const std::string& source, const char* body,
                     const char* thruster, const char* end) {
  Fields fields = vehicle_fields(vehicle, source);
  fields.push_back(fmt::arg("gazebo_inertia", fmt::vformat(kGazeboInertia, fields)));
  std::string text = fmt::vformat(kXmlHead, fields) + fmt::vformat(body, fields);
  for (const IdentifiedThruster& one : vehicle.thrusters) {
    text += fmt::vformat(thruster, thruster_fields(vehicle, one));
  }
  return text + end;
}

// Sources: SDFormat, inertial/fluid_added_mass; gz-sim, Hydrodynamics.hh and Thruster.hh.
constexpr const char* kGazebo =
    R"(<!-- For Gazebo Harmonic (gz-sim 8) and later with DART. Body frame FLU about the origin of the measured velocities. -->
<!-- <fluid_added_mass>: positive, kg, kg m, kg m^2; DART accelerates it with the mass and computes its Coriolis forces. -->
<!-- Hydrodynamics: drag negative (SNAME), N s/m, N s^2/m^2, N m s/rad, N m s^2/rad^2; no added mass there, which would count twice. -->
<sdf version="1.10">
  <model name="identified">
    <link name="base_link">
{gazebo_inertia}        <fluid_added_mass>
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

// Sources: gz-sim, Hydrodynamics.cc ("negative sign signifies the behaviour change": derivatives
// xDotU are negative) and issue 1923 (unstable unless the added mass is below the mass).
constexpr const char* kGazeboPlugin =
    R"(<!-- For Gazebo without <fluid_added_mass>: physics engines other than DART, Garden and earlier. Body frame FLU. -->
<!-- Added mass as derivatives, negative (SNAME): the plugin pushes back with the acceleration of the last step, -->
<!-- which no step makes stable on an axis with more added mass than mass: see the certificate. -->
<!-- Coriolis forces of the added mass are switched off: sway and yaw of the plugin's matrix differ from Fossen's equation. -->
<sdf version="1.9">
  <model name="identified">
    <link name="base_link">
{gazebo_inertia}      </inertial>
    </link>
    <!-- buoyancy: the world's gz::sim::systems::Buoyancy, with a volume of {volume} m^3 -->
    <plugin filename="gz-sim-hydrodynamics-system" name="gz::sim::systems::Hydrodynamics">
      <link_name>base_link</link_name>
{added_derivatives}{damping_sdf}      <disable_coriolis>true</disable_coriolis>
    </plugin>
)";

constexpr const char* kGazeboThruster = R"(    <link name="{name}_propeller">
      <pose>{place_flu} {turn_flu}</pose>
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
    <!-- in reverse {reverse} {per} was {was}, forwards {forward}: this plugin has one coefficient both ways, so command thrusts in N; the limits of the thrust are those of the log -->
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

// Sources: Stonefish, docs/bodies.rst, docs/actuators.rst, SolidEntity.cpp (getAugmentedMass).
constexpr const char* kStonefish =
    R"(<!-- Body frame FRD, world NED, SI. Stonefish takes added mass and drag from the body's geometry and no coefficients: -->
<!-- give base_link a mesh (and its <propeller> to each thruster), then compare with what was identified. -->
<!-- Of the added masses in surge, sway and heave Stonefish accelerates the mean, here {mean_added} kg. -->
<!-- identified added mass (surge, sway, heave, roll, pitch, yaw; kg, kg m^2): {added} -->
<!-- identified linear drag (N s/m, N m s/rad): {linear}; quadratic (N s^2/m^2, N m s^2/rad^2): {quadratic} -->
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
    <origin xyz="{place}" rpy="{turn}"/>
    <link name="Vehicle"/>
  </actuator>
)";

// Sources: uuv_gazebo_plugins, HydrodynamicModel.cc (HMFossen), ThrusterConversionFcn.cc (Bessa).
constexpr const char* kUuv =
    R"(<!-- UUV Simulator and Plankton. Positions FLU (Gazebo); added mass and drag in FRD, to which the plugin turns velocities. -->
<!-- Added mass positive (kg, kg m, kg m^2), drag negative (N s/m, N s^2/m^2, …). The added mass pushes back with a filtered -->
<!-- acceleration of past steps, which is unstable above 5.7 times the mass: see the certificate. -->
<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="identified_hydro_model" params="namespace">
    <link name="${{namespace}}/base_link">
      <neutrally_buoyant>0</neutrally_buoyant>
      <volume>{sea_volume}</volume>
      <center_of_buoyancy>{buoyancy_flu}</center_of_buoyancy>
      <hydrodynamic_model>
        <type>fossen</type>
        <added_mass>
{added_rows}        </added_mass>
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

constexpr const char* kUuvThruster = R"(    <!-- {name_comment}: {per}, {both} -->
    <thruster name="{name_xacro}">
      <origin xyz="{place_flu}" rpy="{turn_flu}"/>
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

std::string gazebo_plugin_sdf(const IdentifiedVehicle& vehicle, const std::string& source) {
  return xml_file(vehicle, source, kGazeboPlugin, kGazeboThruster, "  </model>\n</sdf>\n");
}

std::string uuv_xacro(const IdentifiedVehicle& vehicle, const std::string& source) {
  return xml_file(vehicle, source, kUuv, kUuvThruster, "  </xacro:property>\n</robot>\n");
}

std::string stonefish_xml(const IdentifiedVehicle& vehicle, const std::string& source) {
  return xml_file(vehicle, source, kStonefish, kStonefishThruster, "</robot>\n");
}

std::string vehicle_toml(const IdentifiedVehicle& vehicle, const std::string& source) {
  const bool planar = !vehicle.identified[2];
  return fmt::format(
             "# Identified by `kelpie identify` from {}.\n# {} identified; {}.\n"
             "# Thrusters {}.{}\n\n",
             printable(source, source.size()),
             planar ? "Surge, sway, yaw and the lateral thrusters are"
                    : "Six axes and thrusters are",
             printable(vehicle.rest, vehicle.rest.size()), vehicle.speed_unit,
             planar
                 ? fmt::format(" Constant forces ({:.3g} N, {:.3g} N, {:.3g} N m) aren't part of a "
                               "vehicle file.",
                               vehicle.constant_force(0), vehicle.constant_force(1),
                               vehicle.constant_force(5))
                 : "") +
         simulator::vehicle_text(vehicle.body);
}

}  // namespace kelpie::format
