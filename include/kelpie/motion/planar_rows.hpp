// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace kelpie {

/// The axes of a vehicle in the plane. Forces are in N, N and N m along them.
inline constexpr std::size_t kPlanarAxes = 3;

/// One number per axis: surge, sway, yaw.
using PlanarVector = std::array<double, kPlanarAxes>;

/// What a log tells of a vehicle in the plane: velocities through the water and the speeds of its
/// thrusters. In FLU (sway to port, yaw to port positive) or FRD: what is identified is in the
/// same.
struct PlanarRows {
  std::vector<std::string> thrusters;
  std::vector<double> times_s;     ///< one per row, never decreasing within a stretch
  std::vector<double> velocities;  ///< rows × 3: surge, sway [m/s], yaw rate [rad/s]; finite
  std::vector<double> speeds;      ///< rows × thrusters, in any one unit; thrust goes with n|n|
  std::vector<std::size_t> starts{0};  ///< first row of each stretch without a gap, going up

  std::size_t rows() const { return times_s.size(); }  ///< Their number.
  /// Surge, sway and yaw rate of a row.
  std::span<const double, kPlanarAxes> velocity(std::size_t row) const {
    return std::span<const double>(velocities).subspan(kPlanarAxes * row).first<kPlanarAxes>();
  }
  /// The thrusters' speeds of a row.
  std::span<const double> speed(std::size_t row) const {
    return std::span<const double>(speeds).subspan(thrusters.size() * row, thrusters.size());
  }
};

}  // namespace kelpie
