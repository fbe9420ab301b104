// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <span>

#include "kelpie/svr/regressor.hpp"

namespace kelpie::testing {

/// Knows the first target of small_log() but for an error that is always the same.
class ConstantError final : public OnlineRegressor {
 public:
  explicit ConstantError(double error) : error_(error) {}

  Decision update(std::span<const double> /*x*/, double /*y*/, double /*t*/) override { return {}; }
  double predict(std::span<const double> x) const override { return std::sin(2.0 * x[0]) + error_; }
  Status status() const override { return {}; }

 private:
  double error_;
};

}  // namespace kelpie::testing
