// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <span>
#include <vector>

#include "kelpie/navigation/dead_reckoning.hpp"

namespace kelpie {

/// The filter of a DeadReckoning: states s = (ν, d, c, p, ψ), the last three where it is planar.
/// Everything is of bounded size: nothing allocates but the constructor and copies.
class VelocityFilter {
 public:
  static constexpr int kMostVelocities = 6;
  static constexpr int kPlanar = 5;  ///< current, position, heading
  static constexpr int kMost = 2 * kMostVelocities + kPlanar;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMost, 1>;
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMost, kMost>;

  VelocityFilter(const OpenLoop& model, const DeadReckoningSettings& settings);

  /// At rest in the knowledge of these inputs, whose velocities are all measured.
  void start(std::span<const double> x, const Matrix& noise);

  /// Goes on from where another filter of the same model is. Allocates nothing.
  void join(const VelocityFilter& other);

  /// On by dt_s, to where the commands are those of x, from a moment `age_s` after velocities were
  /// measured last; process noise `factor` times the usual.
  void predict(std::span<const double> x, double dt_s, double age_s, double factor);

  /// Takes in measured values of the states `which` (of s), with their covariance. Returns how far
  /// off they were: squared, in covariances, per value. The fourth in a row that is off by more
  /// than it should ever be is taken over as it is.
  double correct(std::span<const Eigen::Index> which, const Vector& values, const Matrix& noise);

  /// Takes over a yaw rate measured in planar motion. It says nothing of surge and sway: what a
  /// model's slopes would conclude made dead reckoning on a real log worse.
  void take_yaw_rate(double value, double variance);

  /// Whether the last measurement was further off than it should ever be.
  bool doubtful() const { return doubts_ > 0; }

  void forget_position();  ///< From here on, position is counted anew.

  Eigen::Index velocities() const { return velocities_; }
  bool planar() const { return planar_; }
  Eigen::Index current() const { return 2 * velocities_; }
  Eigen::Index position() const { return current() + 2; }
  Eigen::Index heading() const { return current() + 4; }
  const Vector& mean() const { return mean_; }
  const Matrix& covariance() const { return covariance_; }
  const OpenLoop& model() const { return model_; }

 private:
  Vector rate(const Vector& s, double share);
  Matrix slope(const Vector& s, double share);
  void step(double from, double to, double step_s, double factor);
  double lasting_s(Eigen::Index velocity) const;
  void add_noise(double step_s, double factor);
  void keep_in_range();
  void take_over(std::span<const Eigen::Index> which, const Vector& values, const Matrix& noise);

  OpenLoop model_;
  double step_s_;
  double age_s_ = 0.0;  ///< of the outage, where the model is asked
  double current_m_s_;
  double current_wander_;
  CommandPath between_;
  Eigen::Index velocities_;
  bool planar_;
  Vector mean_;
  Matrix covariance_;
  int doubts_ = 0;            ///< measurements in a row further off than they should ever be
  bool yaw_given_ = false;    ///< along the step: measured, where surge isn't
  std::vector<double> from_;  ///< the inputs before
  std::vector<double> to_;    ///< those gone to
  std::vector<double> at_;    ///< scratch: inputs of one evaluation
};

}  // namespace kelpie
