// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>

#include "live/configuration.hpp"
#include "live/output.hpp"
#include "live/receiver.hpp"

namespace kelpie::live {

/// A measured heading for a DeadReckoning (`heading` of [live]). Logs have headings that turn with
/// the yaw rate and headings against it, as a compass beside axes that go forward, left and up: the
/// first turn of the vehicle tells. For the receiving thread.
class HeadingReader {
 public:
  explicit HeadingReader(const Configuration& configuration);

  /// The reading at or before `t` [s] that is newer than the last one, turned on to `t` by the
  /// `yaw_rate` [rad/s], with its sign. Empty: no newer reading, or the sense of readings isn't
  /// known so far. An event of `output` names a signal that turns much faster than the vehicle.
  std::optional<double> next(const Receiver& receiver, double t, double yaw_rate, Output& output);

  /// Readings of a clock that was set count from now on; the sense stays.
  void begin_anew() { last_s_ = -std::numeric_limits<double>::infinity(); }

  /// Where a velocity in the axes of DeadReckoning::current() points, as a reading [rad], 0 to 2 π.
  double reading_of(const std::array<double, 2>& velocity) const;

  /// Whether readings came of late, and their sense is known.
  bool is_known(double t) const;

 private:
  void turn(double reading, double t, double yaw_rate, Output& output);

  std::string name_;
  std::optional<std::size_t> source_;  // empty: no heading is configured
  double gap_s_;
  double sense_ = 0.0;  // 1: with the yaw rate, -1: against it, 0: unknown
  double last_s_ = -std::numeric_limits<double>::infinity();
  double last_ = 0.0;
  double turned_ = 0.0;    // by the readings, since the begin of a turn
  double yawed_ = 0.0;     // by the yaw rate
  bool has_told_ = false;  // that it is no rad
};

}  // namespace kelpie::live
