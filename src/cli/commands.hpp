// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <vector>

namespace kelpie::cli {

// One function per subcommand, each in the file of its name: it adds the subcommand with its
// options to `app` and does the work in the subcommand's callback. Errors leave as exceptions; main
// turns them into messages and exit codes.
//
// An option's type name says what shells complete: FILE, FOLDER, SETTING or {one,of,these}.

void add_compare(CLI::App& app);
void add_completion(CLI::App& app);
void add_config(CLI::App& app);
void add_convert(CLI::App& app);
void add_export(CLI::App& app);
void add_identify(CLI::App& app);
void add_inspect(CLI::App& app);
void add_learn(CLI::App& app);
void add_live(CLI::App& app);
void add_memory(CLI::App& app);
void add_play(CLI::App& app);
void add_predict(CLI::App& app);
void add_simulate(CLI::App& app);
void add_rollout(CLI::App& app);
void add_study(CLI::App& app);
void add_tune(CLI::App& app);

/// The flag --help-all, of the program alone: comes after the subcommands, which would inherit it.
void add_help(CLI::App& app);

/// The subcommands that are in the help.
std::vector<const CLI::App*> visible_commands(const CLI::App& app);

}  // namespace kelpie::cli
