// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace kelpie::cli {

/// Parses the command line and runs the named subcommand. Returns the exit code: 0, 1 for a
/// failure, 2 for bad input. Errors are printed to the standard error stream.
int run_program(CLI::App& app, int argc, char** argv);

}  // namespace kelpie::cli
