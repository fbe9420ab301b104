// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <numbers>
#include <string>

#include "format/identified_vehicle.hpp"

namespace kelpie::format {

/// From per (rev/s)² to per (rad/s)².
inline constexpr double kPerRadians = 1.0 / (4.0 * std::numbers::pi * std::numbers::pi);

/// Text in an element or a quoted attribute.
std::string xml_text(const std::string& text);

/// <!-- text -->, whatever stands in it, indented and with a newline.
std::string xml_comment(const std::string& text, int indent = 0);

/// "1 2 3", to six digits.
std::string xml_numbers(const Eigen::Ref<const Eigen::VectorXd>& values);

/// FRD to FLU, or back: of a matrix of six-vectors, and of a vector.
vehicle::Matrix6 mirrored(const vehicle::Matrix6& matrix);
Eigen::Vector3d mirrored(const Eigen::Vector3d& vector);

/// Where a thruster pushes and which way, FRD: the place on its line that is nearest to the origin.
Eigen::Vector3d thruster_place(const PlanarThruster& thruster);

/// What all files say at their top.
std::string xml_head(const IdentifiedVehicle& vehicle, const std::string& source);

}  // namespace kelpie::format
