// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "log/draft.hpp"
#include "study/first_look.hpp"

namespace kelpie::report {

/// The content of a bag for a terminal: the bag, a line per topic, ranges of the fields.
std::string inspect_table(const bag::BagReport& report, const std::string& source);

/// The signals of a draft, open questions, and the correlation of velocities with commands.
std::string draft_table(const log::Draft& draft, const std::optional<study::FirstLook>& look);

/// Both as JSON (docs/bags.md).
std::string inspect_json(const bag::BagReport& report, const log::Draft& draft,
                         const std::optional<study::FirstLook>& look, const std::string& source);

}  // namespace kelpie::report
