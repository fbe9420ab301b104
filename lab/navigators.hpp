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

/// Somebody who tells surge and sway while the velocity log is silent.
class Navigator {
 public:
  virtual ~Navigator() = default;
  virtual std::unique_ptr<Navigator> clone() const = 0;
  /// One row: inputs, of which those that aren't measured are NaN.
  virtual void update(std::span<const double> x, double t) = 0;
  virtual double velocity(std::size_t state) const = 0;
  /// Of the position since the velocities fell silent, in the body frame of that moment; empty
  /// where it doesn't say.
  virtual std::optional<std::array<double, 4>> position_covariance() const { return {}; }

 protected:
  Navigator() = default;
  Navigator(const Navigator&) = default;
  Navigator(Navigator&&) = default;
  Navigator& operator=(const Navigator&) = default;
  Navigator& operator=(Navigator&&) = default;
};

/// One of them, and what it is called.
struct NamedNavigator {
  std::string name;
  std::unique_ptr<Navigator> navigator;
};

/// kelpie's, with a model that learns the training rows; the same model without a filter
/// (a Rollout); a Kalman filter of a constant current and recursive least squares without a filter,
/// both on Fossen's terms, identified on the same rows; and one that holds the velocity.
/// Requires inputs u, v, r first.
std::vector<NamedNavigator> make_navigators(const log::Dataset& data, const study::Split& split,
                                            const DeadReckoningSettings& settings);

}  // namespace kelpie::lab
