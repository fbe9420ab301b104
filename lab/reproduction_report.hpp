// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "lab/reproduction.hpp"

namespace kelpie::lab {

/// Everything as one HTML file that needs nothing else: no network, no script; well-formed XML.
std::string reproduction_html(const Reproduction& result);

/// All numbers as JSON (docs/reproduction.md). The same plan gives the same bytes, but for what
/// stands under "update_us". NaN is written as null.
std::string reproduction_json(const Reproduction& result);

/// For a terminal: R² at the end of each configuration beside the baseline's, the published
/// protocol, and how many claims hold.
std::string reproduction_table(const Reproduction& result);

// Parts of the reproduction's page.

/// What of the paper holds, and what does not.
std::string claims_section(const Reproduction& result);

/// The settings beside the paper's Table I.
std::string parameters_section();

/// The published experiment with a buffer of 100.
std::string published_section(const Reproduction& result);

/// The opponents' streams.
std::string peers_section(const Reproduction& result);

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
