// SPDX-License-Identifier: Apache-2.0
#include "format/parameters_xml.hpp"

#include <fmt/format.h>

#include <cmath>

namespace kelpie::format {

std::string xml_text(const std::string& text) {
  std::string safe;
  for (const char letter : text) {
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
        safe += static_cast<unsigned char>(letter) < ' ' ? '?' : letter;
    }
  }
  return safe;
}

std::string xml_comment(const std::string& text, int indent) {
  std::string safe;
  for (const char letter : text) {
    const bool doubled = letter == '-' && !safe.empty() && safe.back() == '-';
    safe +=
        doubled ? " -" : std::string(1, static_cast<unsigned char>(letter) < ' ' ? '?' : letter);
  }
  return std::string(static_cast<std::size_t>(indent), ' ') + "<!-- " + safe + " -->\n";
}

std::string xml_numbers(const Eigen::Ref<const Eigen::VectorXd>& values) {
  std::string text;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    text += fmt::format("{}{:.6g}", i > 0 ? " " : "", values(i) + 0.0);
  }
  return text;
}

vehicle::Matrix6 mirrored(const vehicle::Matrix6& matrix) {
  const vehicle::Vector6 sign = (vehicle::Vector6() << 1, -1, -1, 1, -1, -1).finished();
  return sign.asDiagonal() * matrix * sign.asDiagonal();
}

Eigen::Vector3d mirrored(const Eigen::Vector3d& vector) {
  return {vector(0), -vector(1), -vector(2)};
}

Eigen::Vector3d thruster_place(const PlanarThruster& thruster) {
  return {thruster.arm_m * std::sin(thruster.angle_rad),
          -thruster.arm_m * std::cos(thruster.angle_rad), 0.0};
}

std::string xml_head(const IdentifiedVehicle& vehicle, const std::string& source) {
  return xml_comment("Identified by kelpie from " + source +
                     ": surge, sway, yaw and thrusters in the plane. SI.") +
         xml_comment("Not identified: " + vehicle.rest + ". Thrusters' speeds " +
                     vehicle.speed_unit + ".") +
         xml_comment(fmt::format("Constant forces in the log (surge, sway, yaw; FRD): {:.3g} N, "
                                 "{:.3g} N, {:.3g} N m; not in this file",
                                 vehicle.constant_force[0], vehicle.constant_force[1],
                                 vehicle.constant_force[2]));
}

}  // namespace kelpie::format
