// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "health/card.hpp"

namespace kelpie::report {

/// What changed on which vehicle, in some ten lines for a terminal.
std::string health_verdict(const std::vector<health::HealthCard>& cards);

/// For a terminal: what every quantity did since every baseline, and its values by episode.
std::string health_tables(const std::vector<health::HealthCard>& cards);

/// A page: the changes, a figure of each quantity over time with intervals and course, all values.
std::string health_html(const std::vector<health::HealthCard>& cards);

}  // namespace kelpie::report
