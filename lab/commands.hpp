// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/interrupt.hpp"
#include "cli/log_options.hpp"
#include "cli/options.hpp"
#include "cli/progress.hpp"
#include "file/out_folder.hpp"
#include "kelpie/core/error.hpp"
#include "log/dataset.hpp"
#include "simulator/scenario.hpp"

namespace kelpie::lab {

// One function per subcommand, in <name>_command.cpp, as in cli/commands.hpp.
void add_bench(CLI::App& app);
void add_benchmark(CLI::App& app);
void add_control(CLI::App& app);
void add_reckoning(CLI::App& app);
void add_diagnose(CLI::App& app);
void add_health(CLI::App& app);
void add_hostile(CLI::App& app);
void add_identify(CLI::App& app);
void add_opponents(CLI::App& app);
void add_plan(CLI::App& app);
void add_reproduce(CLI::App& app);

/// Adds --seed (the first seed), --threads, and --out (the folder of <name>.json).
void add_run_options(CLI::App* command, std::uint64_t& seed, std::size_t& threads, std::string& out,
                     const std::string& files);
/// Adds --seeds, at least 1.
void add_seeds(CLI::App* command, std::size_t& seeds, const std::string& meaning);

/// An optional log and its configuration file.
struct StudiedLog {
  cli::LogOptions log;
  std::string config;

  void add_to(CLI::App& command);
  bool given() const { return !log.source.path.empty(); }
  /// Reads the log; `held_out` replaces the column of held-out rows.
  log::Dataset read(const std::optional<std::string>& held_out = {}) const;
};

/// The log of a simulated drive, with guessed roles.
log::Dataset simulated_log(const simulator::Scenario& scenario, const std::string& source);

/// Runs a study with a progress bar. `study` takes a function to call with the finished share; the
/// function returns false to stop. After an interrupt by the user: throws Failure, or returns the
/// incomplete result if `partial`.
template <typename Study>
auto run_watched(const char* name, Study study, bool partial = false) {
  const cli::InterruptGuard guard;
  cli::ProgressBar progress(name);
  auto result = study([&progress](double share) {
    progress.at(share);
    return !cli::InterruptGuard::asked();
  });
  if (!partial && cli::InterruptGuard::asked()) {
    throw Failure("interrupted; nothing was written");
  }
  return result;
}

/// The results of a study.
struct StudyReport {
  std::string table;       ///< for the terminal
  std::string json{};      ///< for programs and lab/plot.py
  std::string html{};      ///< a page, or empty
  std::string markdown{};  ///< the page for docs/, or empty
};

/// The files and the progress bar of a study.
struct StudyOutput {
  std::string folder;
  std::string name;  ///< of <name>.json and <name>.html
  const char* progress = "";
  std::vector<std::string> inputs{};  ///< files that must not be overwritten

  /// Throws the errors of take_out_folder().
  file::OutFolder take() const;
  void write(const file::OutFolder& taken, const StudyReport& report) const;  ///< Prints, too.
};

/// Takes the folder, runs the study with a progress bar, writes the files, and prints the table and
/// the paths. Throws Failure after an interrupt by the user.
template <typename Plan, typename Study, typename Report>
void run_study(const StudyOutput& output, Plan plan, Study study, Report report) {
  const file::OutFolder folder = output.take();
  const auto result = run_watched(output.progress, [&](const auto& keep_going) {
    plan.keep_going = keep_going;
    return study(plan);
  });
  output.write(folder, report(result));
}

/// The folder of the scenario files: `scenarios` in the working folder, else beside the installed
/// program, else in the checkout of the build. Throws InputError without such a folder.
std::filesystem::path scenario_folder();

/// `file`, or the file `name` of scenario_folder() if `file` is empty.
std::string scenario_file(const std::string& file, const char* name);

}  // namespace kelpie::lab
