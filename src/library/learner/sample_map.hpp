// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "kelpie/svr/online_svr.hpp"

namespace kelpie {

/// A change of scale on physics terms and target: φ'_k = factor_k φ_k, y' = gain · y + offset.
struct LinearPart {
  double gain = 1.0;
  double offset = 0.0;
};

/// The linear part of a map between two scales. `z`, of a sample's length, holds factor_k in the
/// place of φ_k afterwards. Cost: two maps.
LinearPart linear_part(const SampleMap& map, std::span<double> z);

}  // namespace kelpie
