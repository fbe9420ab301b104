// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/output.hpp"

namespace kelpie::cli {

/// Functions of cli/commands.hpp, in the order of the help.
using Commands = std::vector<void (*)(CLI::App&)>;

/// Parses the words of a command line, without the program's name, runs the named subcommand, and
/// prints to `streams`. Returns the exit code: 0, 1 for a failure, 2 for bad input. Errors are
/// printed to the error stream. At most one call at a time in a process. `meaning` is a sentence.
int run_program(const std::string& name, const std::string& meaning, const Commands& commands,
                const std::vector<std::string>& words, const Streams& streams);

/// The same with the commands of kelpie and no program around: prints to the streams of a
/// StreamGuard, and throws InputError on words that no command takes, and what the command throws.
void run_command(const Commands& commands, const std::vector<std::string>& words);

/// Puts the commands of kelpie into groups by need; the help lists the groups by their first
/// commands.
void group_commands(CLI::App& app);

}  // namespace kelpie::cli
