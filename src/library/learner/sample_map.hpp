// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>

namespace kelpie {

/// Changes a scaled sample and its standardised target in place.
using SampleMap = std::function<void(std::span<double> x, double& y)>;

/// A change of scale on physics terms and target: φ'_k = factor_k φ_k, y' = gain · y + offset.
struct LinearPart {
  double gain = 1.0;
  double offset = 0.0;
};

/// The linear part of a map between two scales. `z`, of a sample's length, holds factor_k in the
/// place of φ_k afterwards. Cost: two maps.
LinearPart linear_part(const SampleMap& map, std::span<double> z);

}  // namespace kelpie
