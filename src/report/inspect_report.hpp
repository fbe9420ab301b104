// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "log/draft.hpp"
#include "study/first_look.hpp"

namespace kelpie::report {

/// What a bag holds, for a terminal: the bag, a line per topic, the ranges of the fields.
std::string inspect_table(const bag::BagReport& report, const std::string& source);

/// What of it a draft takes, what is open, and how far its velocities and commands belong together.
std::string draft_table(const log::Draft& draft, const std::optional<study::FirstLook>& look);

/// All of it as JSON (docs/bags.md).
std::string inspect_json(const bag::BagReport& report, const log::Draft& draft,
                         const std::optional<study::FirstLook>& look, const std::string& source);

}  // namespace kelpie::report
