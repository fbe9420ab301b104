// SPDX-License-Identifier: Apache-2.0
#include "format/simulator_fields.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "core/angle.hpp"
#include "core/text.hpp"

namespace kelpie::format {
namespace {

constexpr double kFreshWater = 1000.0;      // kg/m³
constexpr double kUuvSeaWater = 1028.0;     // kg/m³, the default of UUV Simulator
constexpr double kPropellerDiameter = 0.1;  // m; only its product with the coefficient counts
constexpr double kPerRadians = 1.0 / (4.0 * std::numbers::pi * std::numbers::pi);  // of (rev/s)²

void add(Fields& fields, const char* name, const std::string& value) {
  fields.push_back(fmt::arg(name, value));
}

void add(Fields& fields, const char* name, double value) {
  add(fields, name, fmt::format("{:.6g}", value + 0.0));
}

// FRD to FLU.
simulator::Matrix6 mirrored(const simulator::Matrix6& matrix) {
  const simulator::Vector6 sign = (simulator::Vector6() << 1, -1, -1, 1, -1, -1).finished();
  return sign.asDiagonal() * matrix * sign.asDiagonal();
}

Eigen::Vector3d mirrored(const Eigen::Vector3d& vector) {
  return {vector(0), -vector(1), -vector(2)};
}

// Text in an element or a quoted attribute.
std::string xml_text(const std::string& text) {
  std::string safe;
  for (const char letter : printable(text, text.size())) {
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

// The same for xacro, which runs ${…} and $(…), and takes one of several dollars away.
std::string xacro_text(const std::string& text) {
  std::string safe;
  for (const char letter : xml_text(text)) {
    safe += (letter == '{' || letter == '(') && safe.ends_with('$') ? "$" : "";
    safe += letter;
  }
  return safe;
}

// Text in a comment, which holds no two dashes in a row.
std::string comment_text(const std::string& text) {
  std::string safe;
  for (const char letter : printable(text, text.size())) {
    safe += letter == '-' && !safe.empty() && safe.back() == '-' ? " -" : std::string(1, letter);
  }
  return safe;
}

// The upper triangle, named as in SDFormat: xx, xy, … rr.
std::string added_mass_sdf(const simulator::Matrix6& added) {
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

std::string damping_sdf(const simulator::VehicleParameters& body) {
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

// Added mass as derivatives, which are negative (SNAME 1950).
std::string derivatives_sdf(const simulator::VehicleParameters& body) {
  constexpr std::array kNames{"xDotU", "yDotV", "zDotW", "kDotP", "mDotQ", "nDotR"};
  std::string text;
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    text +=
        fmt::format("      <{0}>{1:.6g}</{0}>\n", kNames[i], -body.added_mass(axis, axis) + 0.0);
  }
  return text;
}

// Forces and moments per newton of each thruster, FRD about the origin.
Eigen::MatrixXd thruster_matrix(const IdentifiedVehicle& vehicle) {
  Eigen::MatrixXd matrix(6, static_cast<Eigen::Index>(vehicle.thrusters.size()));
  for (Eigen::Index i = 0; i < matrix.cols(); ++i) {
    const IdentifiedThruster& thruster = vehicle.thrusters[static_cast<std::size_t>(i)];
    matrix.col(i) << thruster.direction, thruster.position_m.cross(thruster.direction);
  }
  return matrix;
}

std::string short_numbers(const simulator::Vector6& values) {
  std::string text;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    text += fmt::format("{}{:.3g}", i > 0 ? ", " : "", values(i) + 0.0);
  }
  return text;
}

// Yaw and pitch that turn the x axis to a direction; with z up, pitch changes its sign.
std::string turn_of(const Eigen::Vector3d& direction) {
  const double yaw = std::atan2(direction.y(), direction.x());
  const double pitch = -std::asin(std::clamp(direction.z(), -1.0, 1.0));
  return fmt::format("0 {:.6g} {:.6g}", pitch + 0.0, yaw + 0.0);
}

}  // namespace

double lag_of(const IdentifiedVehicle& vehicle, const IdentifiedThruster& thruster) {
  return thruster.lag_s > 0.0 ? thruster.lag_s : vehicle.body.rotor_lag_s;
}

Fields thruster_fields(const IdentifiedVehicle& vehicle, const IdentifiedThruster& thruster) {
  Fields fields;
  const double greatest = thruster.greatest;
  const bool told = thruster.reverse_told;
  add(fields, "name", xml_text(thruster.name));
  add(fields, "name_xacro", xacro_text(thruster.name));
  add(fields, "name_comment", comment_text(thruster.name));
  add(fields, "place", numbers_text(thruster.position_m));
  add(fields, "place_flu", numbers_text(mirrored(thruster.position_m)));
  add(fields, "turn", turn_of(thruster.direction));
  add(fields, "turn_flu", turn_of(mirrored(thruster.direction)));
  const double per_square = vehicle.speeds ? kPerRadians : 1.0;
  add(fields, "forward", thruster.forward * per_square);
  add(fields, "reverse", thruster.reverse * per_square);
  add(fields, "greatest", vehicle.speeds ? greatest * kFullTurn : greatest);
  add(fields, "per", vehicle.speeds ? "N/(rad/s)^2" : "N at full command");
  add(fields, "most_thrust", thruster.forward * greatest * greatest);
  add(fields, "least_thrust", -thruster.reverse * greatest * greatest);
  add(fields, "coefficient",
      thruster.forward * per_square /
          (kFreshWater * kPropellerDiameter * kPropellerDiameter * kPropellerDiameter *
           kPropellerDiameter));
  add(fields, "was", told ? "identified" : "taken as forwards, it never ran so");
  add(fields, "both",
      told ? "both ways identified" : "in reverse taken as forwards, it never ran so");
  add(fields, "note", told ? "" : "    <!-- in reverse taken as forwards, it never ran so -->\n");
  const double lag_s = lag_of(vehicle, thruster);
  const std::string seconds = fmt::format("{:.6g}", lag_s);
  add(fields, "rotor_uuv",
      lag_s > 0.0 ? "<type>FirstOrder</type><timeConstant>" + seconds + "</timeConstant>"
                  : "<type>ZeroOrder</type>");
  add(fields, "rotor_stonefish",
      lag_s > 0.0 ? "<rotor_dynamics type=\"first_order\">\n      <time_constant value=\"" +
                        seconds + "\"/>\n    </rotor_dynamics>"
                  : "<rotor_dynamics type=\"zero_order\"/>");
  return fields;
}

namespace {

// Matrices and lists of programs and YAML.
void add_lists(const IdentifiedVehicle& vehicle, Fields& fields) {
  const simulator::VehicleParameters& body = vehicle.body;
  add(fields, "inertia_m", rows_text(body.inertia_kg_m2, "  ", " ", ";\n"));
  add(fields, "inertia_py", rows_text(body.inertia_kg_m2, "    [", ", ", "],\n"));
  add(fields, "gravity_list", numbers_text(body.centre_of_gravity_m, ", "));
  add(fields, "buoyancy", numbers_text(body.centre_of_buoyancy_m));
  add(fields, "buoyancy_list", numbers_text(body.centre_of_buoyancy_m, ", "));
  add(fields, "weight", body.mass_kg * simulator::kGravity);
  add(fields, "buoyant_force", body.mass_kg * simulator::kGravity + body.net_buoyancy_n);
  const Eigen::MatrixXd arms = thruster_matrix(vehicle);
  add(fields, "arms_m", rows_text(arms, "  ", " ", ";\n"));
  add(fields, "arms_py", rows_text(arms, "    [", ", ", "],\n"));
}

}  // namespace

Fields vehicle_fields(const IdentifiedVehicle& vehicle, const std::string& source) {
  const simulator::VehicleParameters& body = vehicle.body;
  const simulator::Vector6& linear = body.linear_damping;
  const simulator::Vector6& quadratic = body.quadratic_damping;
  const double displaced = body.mass_kg + body.net_buoyancy_n / simulator::kGravity;
  Fields fields;
  add(fields, "source", comment_text(source));
  add(fields, "rest", comment_text(vehicle.rest));
  add(fields, "speeds", comment_text(vehicle.speed_unit));
  add(fields, "what",
      std::ranges::all_of(vehicle.identified, std::identity{})
          ? "six axes and thrusters"
          : "surge, sway, yaw and thrusters in the plane");
  add(fields, "forces", short_numbers(vehicle.constant_force));
  add(fields, "mass", body.mass_kg);
  add(fields, "volume", displaced / kFreshWater);
  add(fields, "sea_volume", displaced / kUuvSeaWater);
  add(fields, "inertia", numbers_text(body.inertia_kg_m2.diagonal()));
  add(fields, "ixx", body.inertia_kg_m2(0, 0));
  add(fields, "iyy", body.inertia_kg_m2(1, 1));
  add(fields, "izz", body.inertia_kg_m2(2, 2));
  add(fields, "ixy_flu", -body.inertia_kg_m2(0, 1));
  add(fields, "ixz_flu", -body.inertia_kg_m2(0, 2));
  add(fields, "iyz", body.inertia_kg_m2(1, 2));
  add(fields, "gravity", numbers_text(body.centre_of_gravity_m));
  add(fields, "gravity_flu", numbers_text(mirrored(body.centre_of_gravity_m)));
  add(fields, "buoyancy_flu",
      numbers_text(
          mirrored(Eigen::Vector3d(body.centre_of_buoyancy_m - body.centre_of_gravity_m))));
  add(fields, "added_sdf", added_mass_sdf(mirrored(body.added_mass)));
  add(fields, "added_derivatives", derivatives_sdf(body));
  add(fields, "added_rows", rows_text(body.added_mass, "          ", " ", "\n"));
  add(fields, "added", numbers_text(body.added_mass.diagonal()));
  add(fields, "mean_added", body.added_mass.diagonal().head<3>().mean());
  add(fields, "added_m", rows_text(body.added_mass, "  ", " ", ";\n"));
  add(fields, "added_py", rows_text(body.added_mass, "    [", ", ", "],\n"));
  add(fields, "damping_sdf", damping_sdf(body));
  add(fields, "linear", numbers_text(linear));
  add(fields, "quadratic", numbers_text(quadratic));
  add(fields, "linear_list", numbers_text(linear, ", "));
  add(fields, "quadratic_list", numbers_text(quadratic, ", "));
  add_lists(vehicle, fields);
  add(fields, "minus_linear", numbers_text((-linear).eval()));
  add(fields, "minus_quadratic", numbers_text((-quadratic).eval()));
  return fields;
}

}  // namespace kelpie::format
