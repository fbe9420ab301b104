// SPDX-License-Identifier: Apache-2.0
#include "cli/options.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

#include "cli/output.hpp"
#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/setting.hpp"

namespace kelpie::cli {
namespace {

// NAME=VALUE in place of a file is a second value after an option that takes one.
CLI::Validator no_assignment() {
  return {[](const std::string& text) {
            std::error_code none;
            const bool is_value = text.find('=') != std::string::npos &&
                                  text.find_first_of("*?[{") == std::string::npos &&
                                  !std::filesystem::exists(text, none);
            return is_value ? "'" + printable(text) +
                                  "' is no file; to give several settings, repeat the option, as "
                                  "in --set a=1 --set b=2"
                            : std::string();
          },
          ""};
}

// With the file of the model where the error is about a column that the model takes.
InputError of_model(const InputError& error, const TrainedModel& model, const std::string& file) {
  std::vector<std::string> columns = model.target_names();
  columns.insert(columns.end(), model.input_names.begin(), model.input_names.end());
  columns.push_back(model.alignment.water.heading);
  const Place& place = error.place();
  const bool is_taken =
      !place.file.empty() && !place.field.empty() && std::ranges::count(columns, place.field) > 0;
  return is_taken ? InputError(place, error.message() + "; a column of the model in " + file)
                  : error;
}

}  // namespace

CLI::Option* add_file(CLI::App* command, const std::string& name, std::string& file,
                      const std::string& meaning) {
  CLI::Option* const option = command->add_option(name, file, meaning)->type_name("FILE");
  return name.starts_with('-') ? option : option->check(no_assignment());
}

void add_files(CLI::App* command, const std::string& name, Words& files,
               const std::string& meaning) {
  const bool is_option = name.starts_with('-');
  CLI::Option* const option =
      command->add_option(name, files, meaning)->type_name("FILE")->allow_extra_args(!is_option);
  if (!is_option) {
    option->check(no_assignment());
  }
}

void add_folder(CLI::App* command, const std::string& name, std::string& folder,
                const std::string& meaning) {
  command->add_option(name, folder, meaning)->type_name("FOLDER");
}

void add_model(CLI::App* command, const std::string& name, std::string& model) {
  model = kLearnedModel;
  add_file(command, name, model, "model.json of `kelpie learn`")->capture_default_str();
}

TrainedModel read_given_model(const std::string& model, format::ModelInfo* info) {
  std::error_code none;
  if (!std::filesystem::exists(model, none)) {
    throw InputError({.file = model, .line = 0, .field = {}},
                     "there is no such model; `kelpie learn` makes one, in " +
                         std::string(kLearnedModel) + " where no --out is given");
  }
  format::ModelInfo read;
  TrainedModel trained = format::read_model(model, &read);
  if (!read.doubt.empty()) {
    warn("{}: WARNING: the model is doubtful: {}\n", model, read.doubt);
  }
  if (info != nullptr) {
    *info = std::move(read);
  }
  return trained;
}

void add_absent(CLI::App& app, const std::string& name, const std::string& where) {
  app.add_subcommand(name)->group("")->allow_extras()->callback([=, program = app.get_name()] {
    throw InputError({.file = program + " " + name, .line = 0, .field = {}}, where);
  });
}

void with_given_model(const std::string& file,
                      const std::function<void(TrainedModel&, const format::ModelInfo&)>& run) {
  format::ModelInfo info;
  TrainedModel model = read_given_model(file, &info);
  try {
    run(model, info);
  } catch (const InputError& error) {
    throw of_model(error, model, file);
  }
}

void add_examples(CLI::App* command, const std::string& first, const std::string& second) {
  command->footer("Examples:\n  kelpie " + first + "\n  kelpie " + second);
}

void add_out(CLI::App* command, std::string& folder, const std::string& meaning) {
  command->add_option("--out", folder, meaning)->capture_default_str()->type_name("FOLDER");
}

CLI::Option* add_list(CLI::App* command, const std::string& name, Words& words,
                      const std::string& meaning) {
  return command->add_option(name, words, meaning)->delimiter(',')->allow_extra_args(false);
}

void AnswerOptions::add_to(CLI::App& command, const std::string& document) {
  CLI::Option* const less =
      command.add_flag("--quiet", quiet, "print nothing but warnings and errors");
  command.add_flag("--verbose", verbose, "print every table below the verdict")->excludes(less);
  if (!document.empty()) {
    command.add_flag("--json", json, "print " + document + " in place of the verdict")
        ->excludes(less);
  }
}

void AnswerOptions::begin() const {
  hush(quiet || json);
  be_brief(!verbose);
}

void Answer::add_files(const file::FileSet& written, const std::filesystem::path& folder,
                       const std::map<std::string, std::string>& kinds) {
  for (const auto& [name, content] : written) {
    if (content) {
      const auto kind = kinds.find(name);
      files.emplace_back(kind == kinds.end() ? "file" : kind->second, (folder / name).string());
    }
  }
}

void give(const Answer& answer, const AnswerOptions& options) {
  if (options.json) {
    answer.document.tell(print_document);
  }
  const auto say_block = [](std::string text) {
    text.resize(text.find_last_not_of('\n') + 1);
    say("{}\n\n", text);
  };
  say_block(answer.verdict);
  if (options.verbose) {
    say_block(answer.tables);
  }
  std::size_t widest = 0;
  for (const auto& [what, file] : answer.files) {
    widest = std::max(widest, what.size());
  }
  for (const auto& [what, file] : answer.files) {
    say("{:<{}} {}\n", what + ":", widest + 1, file);
  }
  for (const std::string& command : answer.next) {
    say("{:<{}} {}\n", &command == &answer.next.front() ? "next:" : "", widest + 1, command);
  }
}

std::string shell_word(const std::string& word) {
  const bool is_plain = !word.empty() && std::ranges::all_of(word, [](char letter) {
    return static_cast<signed char>(letter) < 0 || (letter >= '0' && letter <= '9') ||
           (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
           std::string_view("_-+./,:=@%^").find(letter) != std::string_view::npos;
  });
  if (is_plain) {
    return word;
  }
  std::string quoted = "'";
  for (const char letter : word) {
    quoted += letter == '\'' ? "'\\''" : std::string(1, letter);
  }
  return quoted + "'";
}

void add_set(CLI::App* command, Words& set, const std::string& meaning) {
  command->add_option("--set", set, meaning)->type_name("SETTING")->allow_extra_args(false);
}

void add_seed(CLI::App* command, std::uint64_t& seed, const std::string& meaning) {
  command->add_option("--seed", seed, meaning)->capture_default_str();
}

void add_threads(CLI::App* command, std::size_t& threads) {
  constexpr std::size_t kMostThreads = 1024;
  command->add_option("--threads", threads, "0: one per core")
      ->check(CLI::Range(std::size_t{0}, kMostThreads))
      ->capture_default_str();
}

CLI::Validator within(double low, double high) {
  const std::string range =
      "has to be a number from " + number_text(low) + " to " + number_text(high);
  return {[=](const std::string& text) {
            double value = 0.0;
            const bool is_good = parse_number(text, value) && value >= low && value <= high;
            return is_good ? std::string() : "'" + printable(text) + "' " + range;
          },
          ""};
}

void print_notes(const ModelSettings& settings, const format::SettingsFile& file,
                 const std::vector<std::string>& set, bool scale_given) {
  const auto start = ModelSettings::from_preset(settings.preset, settings.axes.size()).values();
  std::vector<std::string> names;
  for (const auto& value : settings.values()) {
    if (file.settings.contains(value.first) && std::ranges::count(start, value) == 0) {
      names.push_back(value.first);
    }
  }
  for (const std::string& assignment : set) {
    names.push_back(format::key_and_value(assignment).first);
  }
  for (const std::string& note : settings.notes(names, scale_given)) {
    warn("kelpie: {}\n", note);
  }
}

}  // namespace kelpie::cli
