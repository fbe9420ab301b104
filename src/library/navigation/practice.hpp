// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "core/recent_values.hpp"
#include "navigation/velocity_filter.hpp"

namespace kelpie {

/// Simulated outages: a second filter runs without the velocities of the log (a gyro goes on) for a
/// while; its error at the end sets the process noise so that nine in ten errors lie within the
/// 90 % ellipse. Every second outage lasts three times as long, and a quarter of an
/// outage is scored, too: for each of the three ages, the ellipse is widened as the last 24 outages
/// ask, as the bands of rollouts are (conformal_bound()). The way is that of the measured
/// velocities, since teacher and pupil share the teacher's error.
class Practice {
 public:
  /// Outages of `length_s` seconds; 0: none.
  Practice(const VelocityFilter& filter, double length_s);

  /// Follows `teacher` after one sample. `heard`: all velocities of the log were measured in the
  /// sample; only such samples begin and score an outage. `lost`: velocities are silent for too
  /// long, or the log was cut; ends the outage without a score.
  void follow(const VelocityFilter& teacher, std::span<const double> x, double dt_s, bool heard,
              bool lost);

  void stop() { running_ = false; }  ///< Ends the outage without a score.

  /// Goes on with another model of the same inputs and velocities. Allocates.
  void use(const OpenLoop& model) { pupil_.use(model); }

  /// As VelocityFilter::restate().
  void restate(std::span<const double> x, CommandPath between) { pupil_.restate(x, between); }

  /// Factor on the variance of the model's errors.
  double factor() const { return factor_; }

  /// Factor on the standard deviations of the position after an outage of so many seconds, or of
  /// the velocities, where motion isn't planar.
  double widening(double age_s) const { return factor_at(sizes_, age_s); }

  /// The same on the standard deviations of the velocities.
  double velocity_widening(double age_s) const { return factor_at(speeds_, age_s); }

  int judged() const { return judged_; }  ///< Outages so far.
  /// Geometric mean of the errors at the end of outages and the noise of their measurement: a
  /// single outage far off says little of the next.
  double error() const { return std::exp(log_error_); }

 private:
  static constexpr std::size_t kAges = 3;

  using Sizes = std::array<RecentValues, kAges>;
  using Places =
      Eigen::Matrix<Eigen::Index, Eigen::Dynamic, 1, 0, VelocityFilter::kMostVelocities, 1>;

  double age_to_score(std::size_t i) const;
  double bound_of(const RecentValues& sizes) const;
  double factor_at(const Sizes& sizes, double age_s) const;
  Eigen::Vector2d in_world(const VelocityFilter& teacher, std::span<const double> x) const;
  void begin(const VelocityFilter& teacher, std::span<const double> x);
  void take_rates(std::span<const double> x);
  void go_on(const VelocityFilter& teacher, std::span<const double> x, double dt_s, bool heard);
  void judge(const VelocityFilter& teacher, std::span<const double> x);
  void judge_velocities(std::span<const double> x);

  VelocityFilter pupil_;
  Places scored_;  ///< surge and sway in planar motion, else the velocities of the log
  double length_s_;
  bool running_ = false;
  double age_s_ = 0.0;
  std::vector<double> as_heard_;                      ///< inputs, NaN: not measured
  Eigen::Vector2d way_ = Eigen::Vector2d::Zero();     ///< since the start, as measured
  Eigen::Vector2d before_ = Eigen::Vector2d::Zero();  ///< measured velocity in the world
  double way_variance_ = 0.0;                         ///< of the way, by the noise of velocities
  std::size_t next_ = 0;                              ///< the next age to score
  int begun_ = 0;                                     ///< outages
  double heard_s_ = 0.0;                              ///< age at the last measured velocities
  /// Of errors, by age; 1: on the 90 % ellipse of a noise factor of 1.
  Sizes sizes_;
  Sizes speeds_;  ///< the same of velocities
  double factor_ = 1.0;
  int judged_ = 0;
  double log_error_ = 0.0;
};

}  // namespace kelpie
