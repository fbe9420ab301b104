// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <string>

#include "format/parameters.hpp"
#include "format/parameters_xml.hpp"

namespace kelpie::format {
namespace {

constexpr double kWaterDensity = 1000.0;    // kg/m³
constexpr double kPropellerDiameter = 0.1;  // m; only its product with the coefficient counts

// The upper triangle, named as in SDFormat: xx, xy, … rr.
std::string added_mass_sdf(const vehicle::Matrix6& added) {
  constexpr std::array kAxes{'x', 'y', 'z', 'p', 'q', 'r'};
  std::string text = "        <fluid_added_mass>\n";
  for (std::size_t row = 0; row < kAxes.size(); ++row) {
    for (std::size_t column = row; column < kAxes.size(); ++column) {
      text += fmt::format(
          "          <{0}{1}>{2:.6g}</{0}{1}>\n", kAxes[row], kAxes[column],
          added(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) + 0.0);
    }
  }
  return text + "        </fluid_added_mass>\n";
}

std::string link_sdf(const vehicle::VehicleParameters& body) {
  const Eigen::Vector3d centre = mirrored(body.centre_of_gravity_m);
  const Eigen::Matrix3d& inertia = body.inertia_kg_m2;
  // Off the diagonal, x with y and x with z change sign from FRD to FLU.
  return fmt::format(
             "    <link name=\"base_link\">\n      <inertial>\n        <pose>{} 0 0 0</pose>\n"
             "        <mass>{:.6g}</mass>\n        <inertia>\n          <ixx>{:.6g}</ixx>\n"
             "          <iyy>{:.6g}</iyy>\n          <izz>{:.6g}</izz>\n          "
             "<ixy>{:.6g}</ixy>\n"
             "          <ixz>{:.6g}</ixz>\n          <iyz>{:.6g}</iyz>\n        </inertia>\n",
             xml_numbers(centre), body.mass_kg, inertia(0, 0), inertia(1, 1), inertia(2, 2),
             -inertia(0, 1) + 0.0, -inertia(0, 2) + 0.0, inertia(1, 2) + 0.0) +
         added_mass_sdf(mirrored(body.added_mass)) + "      </inertial>\n    </link>\n";
}

std::string damping_sdf(const vehicle::VehicleParameters& body) {
  constexpr std::array kLinear{"xU", "yV", "zW", "kP", "mQ", "nR"};
  constexpr std::array kQuadratic{"xUabsU", "yVabsV", "zWabsW", "kPabsP", "mQabsQ", "nRabsR"};
  std::string text =
      "    <plugin filename=\"gz-sim-hydrodynamics-system\" "
      "name=\"gz::sim::systems::Hydrodynamics\">\n      <link_name>base_link</link_name>\n";
  for (std::size_t i = 0; i < kLinear.size(); ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    text += fmt::format("      <{0}>{1:.6g}</{0}>\n      <{2}>{3:.6g}</{2}>\n", kLinear[i],
                        -body.linear_damping(axis) + 0.0, kQuadratic[i],
                        -body.quadratic_damping(axis) + 0.0);
  }
  return text +
         "      <disable_added_mass>true</disable_added_mass>\n"
         "      <disable_coriolis>true</disable_coriolis>\n    </plugin>\n";
}

std::string thruster_sdf(const IdentifiedVehicle& vehicle, std::size_t index) {
  const PlanarThruster& thruster = vehicle.thrusters[index];
  const std::string name = xml_text(thruster.name);
  const double greatest = vehicle.greatest_rps[index] * vehicle.greatest_rps[index];
  const double diameter4 =
      kPropellerDiameter * kPropellerDiameter * kPropellerDiameter * kPropellerDiameter;
  std::string text = fmt::format(
      "    <link name=\"{0}_propeller\">\n      <pose>{1} 0 0 {2:.6g}</pose>\n      <inertial>\n"
      "        <mass>0.001</mass>\n        <inertia><ixx>1e-6</ixx><iyy>1e-6</iyy><izz>1e-6</izz>"
      "</inertia>\n      </inertial>\n    </link>\n"
      "    <joint name=\"{0}_joint\" type=\"revolute\">\n      <parent>base_link</parent>\n"
      "      <child>{0}_propeller</child>\n      <axis>\n        <xyz>1 0 0</xyz>\n"
      "        <limit><lower>-1e16</lower><upper>1e16</upper></limit>\n      </axis>\n    "
      "</joint>\n",
      name, xml_numbers(mirrored(thruster_place(thruster))), -thruster.angle_rad + 0.0);
  text += xml_comment(
      fmt::format("in reverse {:.6g} N/(rad/s)^2 was {}, forwards {:.6g}: this plugin has one "
                  "coefficient; the limits of the thrust are those of the log",
                  thruster.reverse * kPerRadians,
                  vehicle.reverse_told[index] ? "identified" : "taken as forwards, it never ran so",
                  thruster.forward * kPerRadians),
      4);
  return text +
         fmt::format(
             "    <plugin filename=\"gz-sim-thruster-system\" "
             "name=\"gz::sim::systems::Thruster\">\n      <joint_name>{}_joint</joint_name>\n"
             "      <fluid_density>{:.6g}</fluid_density>\n"
             "      <propeller_diameter>{:.6g}</propeller_diameter>\n"
             "      <thrust_coefficient>{:.6g}</thrust_coefficient>\n"
             "      <max_thrust_cmd>{:.6g}</max_thrust_cmd>\n"
             "      <min_thrust_cmd>{:.6g}</min_thrust_cmd>\n"
             "      <velocity_control>true</velocity_control>\n    </plugin>\n",
             name, kWaterDensity, kPropellerDiameter,
             thruster.forward * kPerRadians / (kWaterDensity * diameter4),
             thruster.forward * greatest, -thruster.reverse * greatest + 0.0);
}

}  // namespace

std::string gazebo_sdf(const IdentifiedVehicle& vehicle, const std::string& source) {
  std::string text = "<?xml version=\"1.0\"?>\n" + xml_head(vehicle, source) +
                     "<sdf version=\"1.10\">\n  <model name=\"identified\">\n" +
                     link_sdf(vehicle.body);
  text += xml_comment(
      "buoyancy: the world's gz::sim::systems::Buoyancy, with a volume of " +
          fmt::format("{:.6g} m^3",
                      (vehicle.body.mass_kg + vehicle.body.net_buoyancy_n / vehicle::kGravity) /
                          kWaterDensity),
      4);
  text += damping_sdf(vehicle.body);
  for (std::size_t i = 0; i < vehicle.thrusters.size(); ++i) {
    text += thruster_sdf(vehicle, i);
  }
  return text + "  </model>\n</sdf>\n";
}

}  // namespace kelpie::format
