// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "kelpie/stream/signal_history.hpp"
#include "kelpie/stream/stream_plan.hpp"
#include "stream/attitude_source.hpp"

namespace kelpie {

/// Weights of StreamPlan::Pose, for s within ±1.
struct PoseKernel {
  static double weight(double s);    ///< w: integral 1, second moment 0
  static double slope(double s);     ///< ẇ
  static double integral(double s);  ///< of w from 0 to s
};

/// Velocities and accelerations of the body around a time, from a pose's sources with clocks of
/// their own; means of other signals with the same weights.
class PoseWindow {
 public:
  /// `most`: samples kept of a source. Requires a valid plan with a pose whose window is known.
  /// Allocates.
  PoseWindow(const StreamPlan& plan, std::size_t most);

  /// Moves the window to ± half_s around t. Values are NaN where a source does not reach over the
  /// window, is silent for longer than the gap, or has too few samples. Cost: O(samples in the
  /// window). Allocates nothing.
  void move_to(std::span<const SignalHistory> signals, double t);

  /// The column of StreamPlan::Pose::columns() at this place.
  double value(std::size_t column) const { return values_[column]; }

  /// The mean of another signal over the window, NaN as above.
  double mean(const SignalHistory& signal, Interpolation between) const;
  /// The mean of an angle [rad], within ±π.
  double mean_angle(const SignalHistory& signal) const;

 private:
  using Motion = std::array<double, 6>;
  /// Increments between the samples of one source.
  struct Increments {
    std::size_t first = 0;
    std::size_t count = 0;
  };

  std::optional<Increments> weigh(const SignalHistory& signal);
  void add_position(std::span<const SignalHistory> signals, std::size_t part);
  void add_angle(std::span<const SignalHistory> signals, std::size_t part);
  template <typename Increment>
  void add(const SignalHistory& signal, Increment increment);
  void set_values(std::span<const SignalHistory> signals);
  template <typename Value>
  double mean_of(const SignalHistory& signal, Interpolation between, Value value) const;

  StreamPlan::Pose pose_;
  double gap_s_;
  std::array<std::size_t, 3> position_{};
  AttitudeSource attitude_;
  AttitudeSource turned_by_;  // of the position: heading alone where z is not measured
  std::vector<std::size_t> axes_;
  double t_ = 0.0;
  Motion velocity_{};
  Motion acceleration_{};
  std::vector<double> weights_;  // of increments, for velocities …
  std::vector<double> slopes_;   // … and accelerations
  std::vector<double> values_;
};

}  // namespace kelpie
