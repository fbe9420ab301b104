// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "kelpie/motion/frame.hpp"
#include "kelpie/stream/signal_history.hpp"

namespace kelpie {

/// Roll, pitch and yaw [rad] of a quaternion w, x, y, z, as in_body() takes both.
Triple roll_pitch_yaw(const std::array<double, 4>& quaternion);

/// The attitude of the vehicle between the samples of its sources: angles go the short way round,
/// quaternions too.
class AttitudeSource {
 public:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  /// `places`: sources of roll, pitch and yaw, kNone where not measured (0); or of a quaternion
  /// w, x, y, z; or nothing (no rotation). `unit` of the angles [rad]. `by_stamps`: times below are
  /// stamps, from which each source's lag is taken off; else times without lag.
  AttitudeSource(std::vector<std::size_t> places, double unit, bool by_stamps);

  const std::vector<std::size_t>& places() const { return places_; }
  bool is_quaternion() const { return places_.size() == 4; }

  /// A world vector along the vehicle's axes at a time; NaN where a source has no value. Allocates
  /// nothing.
  Triple in_body(std::span<const SignalHistory> signals, const Triple& vector, double time_s) const;
  /// Roll, pitch and yaw [rad] at a time. Allocates nothing.
  Triple angles(std::span<const SignalHistory> signals, double time_s) const;

 private:
  std::array<double, 4> at(std::span<const SignalHistory> signals, double time_s) const;

  std::vector<std::size_t> places_;
  double unit_;
  bool by_stamps_;
};

}  // namespace kelpie
