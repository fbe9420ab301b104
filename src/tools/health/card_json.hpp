// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "health/card.hpp"

namespace kelpie::health {

/// health.json (docs/reference/files.md) of the vehicles' cards.
std::string cards_json(const std::vector<HealthCard>& cards);

}  // namespace kelpie::health
