// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "kelpie/online/regressor.hpp"

namespace kelpie::study {

/// Predictions whose novelty is within a tenth of its range, and how good they were.
struct NoveltyBin {
  double from = 0.0;  ///< from <= novelty < to; the last bin has 1 as well
  double to = 0.0;
  std::size_t rows = 0;  ///< without any, the rest is NaN
  double rms_error = std::numeric_limits<double>::quiet_NaN();
  double held = std::numeric_limits<double>::quiet_NaN();  ///< share inside the interval
};

/// Ten bins, or none where no prediction has a novelty; those without one are passed over.
/// Requires as many predictions as truths.
std::vector<NoveltyBin> errors_by_novelty(std::span<const double> truth,
                                          std::span<const Prediction> predicted);

}  // namespace kelpie::study
