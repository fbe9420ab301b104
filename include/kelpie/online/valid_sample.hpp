// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace kelpie {

/// Whether a learner of so many inputs can take a sample at all; else it is Verdict::invalid.
inline bool valid_sample(std::span<const double> x, std::size_t inputs, double y, double t) {
  const auto finite = [](double value) { return std::isfinite(value); };
  return x.size() == inputs && std::ranges::all_of(x, finite) && finite(y) && finite(t);
}

}  // namespace kelpie
