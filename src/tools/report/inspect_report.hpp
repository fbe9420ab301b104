// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "log/draft.hpp"
#include "log/plausibility.hpp"
#include "study/first_look.hpp"

namespace kelpie::report {

/// The content of a bag for a terminal: the bag, a line per topic, ranges of the fields.
std::string inspect_table(const bag::BagReport& report, const std::string& source);

/// The signals of a draft, open questions, and the correlation of velocities with commands.
std::string draft_table(const log::Draft& draft, const std::optional<study::FirstLook>& look);

/// What cannot be right in a log, a line each with the remedy.
std::string mistakes_text(const std::vector<log::Mistake>& mistakes);

/// All as JSON (docs/reference/formats.md).
std::string inspect_json(const bag::BagReport& report, const log::Draft& draft,
                         const std::optional<study::FirstLook>& look,
                         const std::vector<log::Mistake>& mistakes, const std::string& source);

}  // namespace kelpie::report
