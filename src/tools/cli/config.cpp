// SPDX-License-Identifier: Apache-2.0

#include <string>

#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/output.hpp"
#include "format/settings_file.hpp"
#include "format/settings_toml.hpp"
#include "kelpie/model/settings.hpp"

namespace kelpie::cli {
namespace {

struct ConfigArguments {
  std::string file;
  std::vector<std::string> set;
  std::size_t axes = 3;
  bool all = false;
  bool markdown = false;
};

void print_markdown() {
  for (const SettingSection& section : setting_sections()) {
    say("## {}\n\n| setting | meaning | allowed |", section.title);
    for (const std::string_view preset : preset_names()) {
      say(" `{}` |", preset);
    }
    say("\n|---|---|---|");
    for (std::size_t i = 0; i < preset_names().size(); ++i) {
      say("---|");
    }
    say("\n");
    for (const SettingText& doc : section.settings) {
      say("| `{}` | {} | {} |", doc.name, doc.meaning, doc.allowed);
      for (const std::string& value : doc.presets) {
        say(" {} |", value);
      }
      say("\n");
    }
    say("\n");
  }
}

void print_config(const ConfigArguments& options) {
  if (options.markdown) {
    print_markdown();
    return;
  }
  const format::SettingsFile file = format::read_settings_file(options.file);
  const ModelSettings settings = format::make_settings(file, options.set, options.axes);
  print_notes(settings, file, options.set);
  say("{}", format::settings_toml(settings, options.all));
}

}  // namespace

void add_config(CLI::App& app) {
  const auto [command, options] = add_command(
      app, "config", "Print the essential settings with their meaning, as TOML", print_config);
  add_file(command, "--config", options->file, "start from this file");
  add_set(command, options->set);
  command->add_option("--axes", options->axes, "number of targets")->check(CLI::Range(1, 64));
  command->add_flag("--all", options->all,
                    "all settings, by groups, instead of the essential ones");
  command->add_flag("--markdown", options->markdown, "tables of docs/reference/settings.md");
  add_examples(command, "config > settings.toml", "config --all --set preset=paper --axes 3");
}

}  // namespace kelpie::cli
