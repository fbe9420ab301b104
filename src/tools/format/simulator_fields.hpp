// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/args.h>
#include <fmt/format.h>

#include <string>

#include "format/identified_vehicle.hpp"
#include "simulator/parameters.hpp"

namespace kelpie::format {

// The files of simulators are templates: {name} is replaced by a value, with six digits.

using Fields = fmt::dynamic_format_arg_store<fmt::format_context>;

/// Values of a vehicle for templates; `source`: the log.
Fields vehicle_fields(const IdentifiedVehicle& vehicle, const std::string& source);

/// Values of one thruster.
Fields thruster_fields(const IdentifiedVehicle& vehicle, const IdentifiedThruster& thruster);

/// Time constant of a thruster: as identified, else the vehicle file's.
double lag_of(const IdentifiedVehicle& vehicle, const IdentifiedThruster& thruster);

/// "1 2 3" with six digits.
template <typename Vector>
std::string numbers_text(const Vector& values, const char* separator = " ") {
  std::string text;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    text += fmt::format("{}{:.6g}", i > 0 ? separator : "", values(i) + 0.0);
  }
  return text;
}

/// Every row of a matrix as a line between `before` and `after`.
template <typename Matrix>
std::string rows_text(const Matrix& matrix, const char* before, const char* separator,
                      const char* after) {
  std::string text;
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    text += before + numbers_text(matrix.row(row), separator) + after;
  }
  return text;
}

}  // namespace kelpie::format
