// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): CLI11's
class App;       // <CLI/CLI.hpp> takes 7 s to compile, and programs need not know the class
}

namespace kelpie::cli {

// One function per subcommand, in the file of the same name. The function adds the subcommand with
// its options to `app`; the subcommand's callback does the work. run_program() turns exceptions
// into messages and exit codes.
//
// The type name of an option tells shells how to complete: FILE, FOLDER, SETTING or {a,b,c}.

void add_compare(CLI::App& app);
void add_completion(CLI::App& app);
void add_config(CLI::App& app);
void add_convert(CLI::App& app);
void add_export(CLI::App& app);
void add_health(CLI::App& app);
void add_identify(CLI::App& app);
void add_inspect(CLI::App& app);
void add_learn(CLI::App& app);
void add_memory(CLI::App& app);
void add_plan(CLI::App& app);
void add_predict(CLI::App& app);
void add_simulate(CLI::App& app);
void add_rollout(CLI::App& app);
void add_study(CLI::App& app);
void add_tune(CLI::App& app);
void add_vehicle(CLI::App& app);

/// A command that a build of the program is without: hidden, and refused with the place of the
/// command.
void add_absent(CLI::App& app, const std::string& name, const std::string& where);

/// Two command lines, without "kelpie ", for the end of the help.
void add_examples(CLI::App* command, const std::string& first, const std::string& second);

/// The flag --help-all of the program. Added after the subcommands, so that they don't inherit the
/// flag.
void add_help(CLI::App& app);

/// The subcommands in the help.
std::vector<const CLI::App*> visible_commands(const CLI::App& app);

}  // namespace kelpie::cli
