// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "kelpie/navigation/dead_reckoning.hpp"

namespace kelpie {

/// The Kalman filter of a DeadReckoning: states s = (ν, d, c, p, ψ), the last three in planar
/// motion only. All sizes are bounded: only the constructor and copies allocate.
class VelocityFilter {
 public:
  static constexpr int kMostVelocities = 6;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2 * kMostVelocities + 5, 1>;
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0,
                               Vector::MaxRowsAtCompileTime, Vector::MaxRowsAtCompileTime>;

  VelocityFilter(const OpenLoop& model, const DeadReckoningSettings& settings);

  /// Starts at inputs with all velocities measured.
  void start(std::span<const double> x, const Matrix& noise);

  /// Copies the state of another filter of the same model. Allocates nothing.
  void join(const VelocityFilter& other);

  /// Predicts by dt_s to the commands of x; `factor` on the process noise.
  void predict(std::span<const double> x, double dt_s, double factor);

  /// Goes on with another model of the same inputs and velocities. Allocates.
  void use(const OpenLoop& model);

  /// The last commands are those of x (NaN: unknown), and so change until the next ones.
  void restate(std::span<const double> x, CommandPath between);

  /// Corrects by measured values of the states `which` (of s) with their covariance. Returns the
  /// squared Mahalanobis distance per value. No velocity moves by more than three standard
  /// deviations, nor by three of those times `widening`; the third outlier of a state in succession
  /// that agrees with those before widens them.
  double correct(std::span<const Eigen::Index> which, const Vector& values, const Matrix& noise,
                 double widening = 1.0);

  /// Sets a state (of s) as measured, without a correction of the others. Of the yaw rate of planar
  /// motion, since a correction of surge and sway by the model's slopes made dead reckoning on a
  /// real log worse; of the heading, with which current and position turn, as the velocities stay.
  void take(Eigen::Index state, double value, double variance);

  /// Rates of the velocities that the equations of motion expect at these velocities (NaN: the
  /// estimate's), under the last commands.
  Vector expected_rates(std::span<const double> velocities);

  /// Whether the last measurement of a velocity was an outlier.
  bool doubtful(Eigen::Index velocity) const {
    return doubts_[static_cast<std::size_t>(velocity)] > 0;
  }

  void forget_position();  ///< Position starts at 0 again.

  Eigen::Index velocities() const { return velocities_; }
  bool planar() const { return planar_; }
  /// Whether the velocity log measures the velocity, and no gyro of its own.
  bool is_of_log(Eigen::Index velocity) const {
    return of_log_[static_cast<std::size_t>(velocity)];
  }
  Eigen::Index current() const { return 2 * velocities_; }
  Eigen::Index position() const { return current() + 2; }
  Eigen::Index heading() const { return current() + 4; }
  const Vector& mean() const { return mean_; }
  const Matrix& covariance() const { return covariance_; }
  const OpenLoop& model() const { return model_; }

 private:
  static constexpr int kPlanar = 5;  ///< current, position, heading

  Vector rate(const Vector& s, double share);
  Matrix slope(const Vector& s, double share);
  void step(double from, double to, double step_s, double factor);
  double lasting_s(Eigen::Index velocity) const;
  void add_noise(double step_s, double factor);
  void keep_in_range();
  void turn_to(double heading_rad);
  void take_over(std::span<const Eigen::Index> which, const Vector& values, const Matrix& noise);
  int count_doubts(std::span<const Eigen::Index> which, const Vector& missing, bool is_far);
  bool agrees(std::span<const Eigen::Index> which, const Vector& missing) const;
  void loosen(std::span<const Eigen::Index> which, const Vector& missing);
  void extend_range(std::span<const Eigen::Index> which, const Vector& values);

  OpenLoop model_;
  double step_s_;
  double current_m_s_;
  double current_wander_;
  CommandPath between_;
  Eigen::Index velocities_;
  bool planar_;
  std::array<bool, kMostVelocities> of_log_{};
  Vector mean_;
  Matrix covariance_;
  std::array<int, Vector::MaxRowsAtCompileTime> doubts_{};  ///< outliers in succession, per state
  Vector doubted_;            ///< errors of the last outlier, per state; NaN: none
  bool yaw_given_ = false;    ///< the yaw rate is measured along the step, surge is not
  std::vector<double> from_;  ///< the inputs before
  std::vector<double> to_;    ///< the inputs after
  std::vector<double> at_;    ///< scratch: inputs of one evaluation
};

}  // namespace kelpie
