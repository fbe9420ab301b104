// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace kelpie {

/// The greatest value that a learner takes: its products can still be added up.
inline constexpr double kMostValue = 1e50;

/// Whether a learner of so many inputs can take a sample at all; else it is Verdict::invalid.
inline bool valid_sample(std::span<const double> x, std::size_t inputs, double y, double t) {
  const auto usable = [](double value) { return std::abs(value) <= kMostValue; };
  return x.size() == inputs && std::ranges::all_of(x, usable) && usable(y) && std::isfinite(t);
}

}  // namespace kelpie
