// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "navigation/velocity_filter.hpp"

namespace kelpie {

/// Simulated outages: a second filter runs without velocities (except the yaw rate in planar
/// motion) for a while; its error at the end sets the process noise so that nine in ten errors lie
/// within the 90 % ellipse.
class Practice {
 public:
  /// Outages of `length_s` seconds; 0: none.
  Practice(const VelocityFilter& filter, double length_s)
      : pupil_(filter), length_s_(length_s), as_heard_(filter.model().seen.size()) {}

  /// Follows `teacher` after one sample; a sample without all velocities (`heard`) ends the outage
  /// without a score.
  void follow(const VelocityFilter& teacher, std::span<const double> x, double dt_s, bool heard);

  /// Factor on the variance of the model's errors.
  double factor() const { return factor_; }

  int judged() const { return judged_; }   ///< Outages so far.
  double error() const { return error_; }  ///< Mean error at the end of outages.

 private:
  void begin(const VelocityFilter& teacher);
  void go_on(const VelocityFilter& teacher, std::span<const double> x, double dt_s);
  void judge(const VelocityFilter& teacher);

  VelocityFilter pupil_;
  double length_s_;
  bool running_ = false;
  double age_s_ = 0.0;
  std::vector<double> as_heard_;                      ///< inputs, NaN: not measured
  Eigen::Vector2d way_ = Eigen::Vector2d::Zero();     ///< way of the teacher since the start
  Eigen::Vector2d before_ = Eigen::Vector2d::Zero();  ///< the teacher's velocity in the world
  double factor_ = 1.0;
  int judged_ = 0;
  double error_ = 0.0;
};

}  // namespace kelpie
