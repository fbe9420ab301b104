// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "log/candidates.hpp"

namespace kelpie::log {

/// Fields of a topic that may be a command by name: of a table all columns; of a topic of a type
/// that isn't known the likeliest one (known_command_fields), or else those called as commands are;
/// of sequences all elements.
std::vector<std::string> command_paths(const bag::TopicReport& topic);

/// Columns that are commands by their names. Names of one kind that differ in their words for it
/// alone (pwm1, pwm2 and rpm1, rpm2) are two readings, and two candidates; else all are one.
std::vector<Candidate> named_commands(const std::vector<CandidateColumn>& columns);

}  // namespace kelpie::log
