// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "core/most_value.hpp"

namespace kelpie {

/// Whether a sample is valid for a learner of `inputs` inputs; else Verdict::invalid.
inline bool valid_sample(std::span<const double> x, std::size_t inputs, double y, double t) {
  return x.size() == inputs && std::ranges::all_of(x, is_usable) && is_usable(y) &&
         std::isfinite(t);
}

}  // namespace kelpie
