// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "kelpie/core/error.hpp"
#include "kelpie/svr/regressor.hpp"

namespace kelpie {

/// The answer at an x with a number that isn't finite.
inline void be_unknown(double& value) {
  value = std::numeric_limits<double>::quiet_NaN();
}
inline void be_unknown(Prediction& prediction) {
  prediction = {.value = std::numeric_limits<double>::quiet_NaN(), .novelty = 1.0};
}

/// Fills y with the predictions one(axis) at x, for all models. Throws InputError on an x of other
/// size than `inputs` or a y of other size than `axes`. At an x with a number that isn't finite, y
/// is unknown.
template <typename Value, typename One>
void answer(std::span<const double> x, std::size_t inputs, std::span<Value> y, std::size_t axes,
            One one) {
  require_size("x", x.size(), inputs);
  require_size("y", y.size(), axes);
  const bool finite = std::ranges::all_of(x, [](double value) { return std::isfinite(value); });
  for (std::size_t axis = 0; axis < axes; ++axis) {
    if (finite) {
      y[axis] = one(axis);
    } else {
      be_unknown(y[axis]);
    }
  }
}

/// answer() with derivatives: one(axis, gradient).
template <typename One>
void answer(std::span<const double> x, std::size_t inputs, std::span<double> y, std::size_t axes,
            std::span<double> jacobian, One one) {
  require_size("jacobian", jacobian.size(), axes * inputs);
  std::ranges::for_each(jacobian, [](double& slope) { be_unknown(slope); });
  answer(x, inputs, y, axes,
         [&](std::size_t axis) { return one(axis, jacobian.subspan(axis * inputs, inputs)); });
}

}  // namespace kelpie
