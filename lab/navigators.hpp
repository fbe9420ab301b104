// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kelpie/navigation/dead_reckoning.hpp"
#include "log/dataset.hpp"
#include "study/split.hpp"

namespace kelpie::lab {

/// An estimator of surge and sway during an outage of the velocity log.
class Navigator {
 public:
  virtual ~Navigator() = default;
  virtual std::unique_ptr<Navigator> clone() const = 0;
  /// A row of inputs, NaN where not measured.
  virtual void update(std::span<const double> x, double t) = 0;
  virtual double velocity(std::size_t state) const = 0;
  /// Covariance of the position since the start of the outage, in the body frame of the start;
  /// empty for navigators without a covariance.
  virtual std::optional<std::array<double, 4>> position_covariance() const { return {}; }
  /// Covariance of measured minus estimated surge and sway; empty as above.
  virtual std::optional<std::array<double, 4>> velocity_covariance() const { return {}; }
  /// Largest change of a velocity by the last measurement, in standard deviations before; 0 for
  /// navigators without a covariance.
  virtual double step() const { return 0.0; }
};

/// A navigator and its name.
struct NamedNavigator {
  std::string name;
  std::unique_ptr<Navigator> navigator;
};

/// The navigators: DeadReckoning with a model of the training rows; the same model without a filter
/// (a Rollout); a Kalman filter of a constant current, and recursive least squares without a
/// filter, both on Fossen's terms, identified on the same rows; and the last velocity held.
/// Requires inputs u, v, r first.
std::vector<NamedNavigator> make_navigators(const log::Dataset& data, const study::Split& split,
                                            const DeadReckoningSettings& settings);

}  // namespace kelpie::lab
