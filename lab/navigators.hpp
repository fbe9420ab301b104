// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/navigation/dead_reckoning.hpp"
#include "log/dataset.hpp"

namespace kelpie::lab {

/// A row of a log. Inputs are NaN where not measured; accelerations are those of the targets.
struct SensedRow {
  std::span<const double> x;
  std::span<const double> accelerations;
  double time_s = 0.0;
};

/// An estimator of surge and sway during an outage of the velocity log.
class Navigator {
 public:
  virtual ~Navigator() = default;
  virtual std::unique_ptr<Navigator> clone() const = 0;
  virtual void update(const SensedRow& row) = 0;
  /// Goes on with another model of the same inputs.
  virtual void use(const OpenLoop& /*model*/) {}
  virtual double velocity(std::size_t state) const = 0;
  /// Covariance of the position since the start of the outage, in the body frame of the start;
  /// empty for navigators without a covariance.
  virtual std::optional<std::array<double, 4>> position_covariance() const { return {}; }
  /// Covariance of measured minus estimated surge and sway; empty as above.
  virtual std::optional<std::array<double, 4>> velocity_covariance() const { return {}; }
  /// Largest change of a velocity by the last measurement, in standard deviations before; 0 for
  /// navigators without a covariance.
  virtual double step() const { return 0.0; }
  /// Whether surge and sway of the last row count as measured; empty for navigators that believe
  /// whatever the velocity log says.
  virtual std::optional<bool> believes() const { return {}; }
};

/// A navigator and its name.
struct NamedNavigator {
  std::string name;
  std::unique_ptr<Navigator> navigator;
};

/// The navigators, and the learner of their models: DeadReckoning with kelpie's equations of
/// motion; the same model without a filter (a Rollout); a Kalman filter of a constant current, and
/// recursive least squares without a filter, both on Fossen's terms, identified on the same rows;
/// an IMU alone; and the last velocity held. Requires inputs u, v, r first.
///
/// The IMU is simulated in favour of the IMU: the log's accelerations, which follow from its
/// velocities, with the gravity that a constant error of roll and pitch leaves (0.1 degrees
/// standard deviation, drawn anew for every outage), and the measured yaw rate.
class NavigatorSet {
 public:
  /// `data` has to outlive the set.
  NavigatorSet(const log::Dataset& data, const DeadReckoningSettings& settings);

  void learn(std::size_t row);
  void learn_held_back() { model_.learn_held_back(); }
  /// Every navigator goes on with a model of all rows learned so far; the first call makes the
  /// navigators. Throws InputError, without a change, where too little is learned.
  void renew();
  /// The same; false, without a change, where too little is learned.
  bool try_to_renew();

  std::vector<NamedNavigator>& navigators() { return navigators_; }

 private:
  const log::Dataset& data_;
  DeadReckoningSettings settings_;
  DynamicsModel model_;
  std::vector<std::size_t> rows_;
  std::vector<NamedNavigator> navigators_;
};

}  // namespace kelpie::lab
