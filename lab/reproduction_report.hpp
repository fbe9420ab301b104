// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "lab/reproduction.hpp"

namespace kelpie::lab {

/// The self-contained page: HTML without network access, well-formed XML.
std::string reproduction_html(const Reproduction& result);

/// The numbers as JSON (docs/reproduction.md). The same plan gives the same bytes, except for
/// "update_us". NaN is written as null.
std::string reproduction_json(const Reproduction& result);

/// For a terminal: R² at the end of each configuration beside the baseline's, the published
/// protocol, and the number of verified claims.
std::string reproduction_table(const Reproduction& result);

/// R² of contenders on an axis over the stream: mean of the seeds as a line, least to greatest as a
/// band, the off-line baseline as steps. The figure ends at −0.2; the caption mentions lower
/// values.
std::string comparison_figure(const StreamStudy& study, const std::vector<std::string>& keys,
                              std::size_t axis);

/// The first seed's held-out rows at the end of a stage, true and predicted, over time.
std::string prediction_figure(const StreamStudy& study, std::string_view key, std::size_t axis,
                              std::size_t stage);

/// R² on the published test rows over the steps.
std::string published_figure(const std::vector<PublishedRun>& runs);

}  // namespace kelpie::lab
