// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.hpp"
#include "file/atomic_file.hpp"
#include "format/model_json.hpp"
#include "format/settings_file.hpp"
#include "kelpie/model/settings.hpp"
#include "kelpie/model/trained_model.hpp"

namespace kelpie::cli {

// Options of several commands, each with one wording and type name.

/// Adds a subcommand that calls `run`. Returns the subcommand and the values of its options; the
/// caller adds the options.
template <typename Options>
std::pair<CLI::App*, std::shared_ptr<Options>> add_command(CLI::App& app, const std::string& name,
                                                           const std::string& meaning,
                                                           void (*run)(const Options&)) {
  auto options = std::make_shared<Options>();
  CLI::App* const command = app.add_subcommand(name, meaning);
  command->callback([run, options] { run(*options); });
  return {command, options};
}

using Words = std::vector<std::string>;

CLI::Option* add_file(CLI::App* command, const std::string& name, std::string& file,
                      const std::string& meaning);
void add_files(CLI::App* command, const std::string& name, Words& files,
               const std::string& meaning);
void add_folder(CLI::App* command, const std::string& name, std::string& folder,
                const std::string& meaning);

/// The model.json that `kelpie learn` writes where nothing else is said.
inline constexpr const char* kLearnedModel = "out/learn/model.json";

/// An option or argument for a model of `kelpie learn`, by default kLearnedModel.
void add_model(CLI::App* command, const std::string& name, std::string& model);

/// Reads the model of add_model(), with `info` where wanted, and warns of a doubtful model. Throws
/// InputError as format::read_model() does; a missing file is told with the command that makes one.
TrainedModel read_given_model(const std::string& model, format::ModelInfo* info = nullptr);

/// Calls `run` with the model of a file, as read_given_model(). An InputError of a log about a
/// column that the model takes names the file of the model, too.
void with_given_model(const std::string& file,
                      const std::function<void(TrainedModel&, const format::ModelInfo&)>& run);

/// The option --out of a folder with a default.
void add_out(CLI::App* command, std::string& folder, const std::string& meaning);

/// An option with words separated by commas, and repeatable; the next word is no part of it.
CLI::Option* add_list(CLI::App* command, const std::string& name, Words& words,
                      const std::string& meaning);

/// How a command answers: --verbose, --quiet and --json.
struct AnswerOptions {
  bool verbose = false;
  bool quiet = false;
  bool json = false;

  /// `document` is the file that --json prints; empty: there is no such option.
  void add_to(CLI::App& command, const std::string& document);

  /// First of all in a command: hushes say() where nothing, or the document alone, is wanted.
  void begin() const;
};

/// The answer of a command.
struct Answer {
  std::string verdict{};                                     ///< some ten lines
  std::string tables{};                                      ///< for --verbose
  file::Content document{""};                                ///< for --json
  std::vector<std::pair<std::string, std::string>> files{};  ///< what each is, and its path
  std::vector<std::string> next{};                           ///< commands that a user needs next

  /// Adds the files of `written` that have content, with their places in `folder`. `kinds` tells
  /// what a file is, by name; the others are called "file".
  void add_files(const file::FileSet& written, const std::filesystem::path& folder,
                 const std::map<std::string, std::string>& kinds = {});
};

/// Prints the answer to stdout.
void give(const Answer& answer, const AnswerOptions& options);

/// A word as a shell takes it: in quotes where it has other signs than those of names and numbers.
std::string shell_word(const std::string& word);

void add_set(CLI::App* command, Words& set,
             const std::string& meaning = "key=value, over the file (repeatable)");
void add_seed(CLI::App* command, std::uint64_t& seed,
              const std::string& meaning = "of the random split");
void add_threads(CLI::App* command, std::size_t& threads);

/// The check of an option's number: finite and from `low` to `high`, which the message names.
CLI::Validator within(double low, double high);

/// Prints to stderr the user's settings without effect (ModelSettings::notes): settings of --set,
/// and settings of the file that differ from the preset. A file printed by `kelpie config` gives no
/// notes.
void print_notes(const ModelSettings& settings, const format::SettingsFile& file,
                 const std::vector<std::string>& set, bool scale_given = false);

}  // namespace kelpie::cli
