// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "cli/output.hpp"

namespace kelpie::cli {

/// Parses the words of a command line, without the program's name, runs the named subcommand, and
/// prints to `streams`. Returns the exit code: 0, 1 for a failure, 2 for bad input. Errors are
/// printed to the error stream. At most one call at a time in a process.
int run_program(CLI::App& app, const std::vector<std::string>& words, const Streams& streams);

/// Parses the words of a command line, without the program's name, and runs the named subcommand.
/// Throws InputError on words that the command doesn't take, and what the command throws.
void run_command(CLI::App& app, const std::vector<std::string>& words);

}  // namespace kelpie::cli
