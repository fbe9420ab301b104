// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace kelpie::lab {

// As cli/commands.hpp: one function per subcommand, in <name>_command.cpp.
void add_bench(CLI::App& app);
void add_control(CLI::App& app);
void add_reckoning(CLI::App& app);
void add_diagnose(CLI::App& app);
void add_identify(CLI::App& app);
void add_reproduce(CLI::App& app);

}  // namespace kelpie::lab
