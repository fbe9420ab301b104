// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "lab/reproduction.hpp"

namespace kelpie::lab {

/// R² of some contenders on one axis over the stream: mean of the seeds as a line, least to
/// greatest as a band; the off-line baseline's level as steps, where there is one. The figure ends
/// at −0.2, and the caption says so where anything lies lower.
std::string comparison_figure(const StreamStudy& study, const std::vector<std::string>& keys,
                              std::size_t axis);

/// The first seed's held-out rows at the end of a stage, true and predicted, over time.
std::string prediction_figure(const StreamStudy& study, std::string_view key, std::size_t axis,
                              std::size_t stage);

/// R² on the published test rows over the steps.
std::string published_figure(const std::vector<PublishedRun>& runs);

}  // namespace kelpie::lab
