// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "navigation/velocity_filter.hpp"

namespace kelpie {

/// Outages that are only practised: a second filter goes without velocities (but the yaw rate of
/// planar motion) for a while, and what it is off by at the end says how large the process noise
/// has to be for nine in ten errors to lie within their 90 % ellipse.
class Practice {
 public:
  /// Outages of so many seconds; 0: none.
  Practice(const VelocityFilter& filter, double length_s)
      : pupil_(filter), length_s_(length_s), as_heard_(filter.model().seen.size()) {}

  /// One sample further, which `teacher` has taken in already. Where it didn't hear all velocities,
  /// the outage at hand is given up.
  void follow(const VelocityFilter& teacher, std::span<const double> x, double dt_s, bool heard);

  /// Factor on the variance of the model's errors.
  double factor() const { return factor_; }

  int judged() const { return judged_; }   ///< Outages so far.
  double error() const { return error_; }  ///< Mean of what they were off by at their end.

 private:
  void begin(const VelocityFilter& teacher);
  void go_on(const VelocityFilter& teacher, std::span<const double> x, double dt_s);
  void judge(const VelocityFilter& teacher);

  VelocityFilter pupil_;
  double length_s_;
  bool running_ = false;
  double age_s_ = 0.0;
  std::vector<double> as_heard_;                      ///< inputs, NaN where nothing is heard
  Eigen::Vector2d way_ = Eigen::Vector2d::Zero();     ///< as the teacher went since the beginning
  Eigen::Vector2d before_ = Eigen::Vector2d::Zero();  ///< the teacher's velocity in the world
  double factor_ = 1.0;
  int judged_ = 0;
  double error_ = 0.0;
};

}  // namespace kelpie
