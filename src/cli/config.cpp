// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <memory>
#include <string>

#include "commands.hpp"
#include "config_file.hpp"
#include "kelpie/core/text.hpp"
#include "kelpie/model/settings.hpp"

namespace kelpie::cli {
namespace {

struct Options {
  std::string file;
  std::vector<std::string> set;
  std::size_t axes = 3;
  bool markdown = false;
};

// A value as TOML has it: numbers bare, words in quotes, one per axis in a list.
std::string toml_value(const std::string& text) {
  const std::vector<std::string> parts = split_text(text, ',');
  std::vector<std::string> values;
  for (const std::string& part : parts) {
    double number = 0.0;
    values.push_back(parse_number(part, number) ? part : '"' + part + '"');
  }
  return values.size() == 1 ? values.front() : "[" + join_text(values, ", ") + "]";
}

void print_toml(const ModelSettings& settings) {
  const auto values = settings.values();
  const std::vector<SettingDoc> docs = setting_docs();
  fmt::print("# Settings of kelpie. One value for all targets, or a list with one per target.\n");
  for (std::size_t i = 0; i < values.size(); ++i) {
    fmt::print("\n# {} ({})\n{} = {}\n", docs[i].meaning, docs[i].allowed, values[i].first,
               toml_value(values[i].second));
  }
}

void print_markdown() {
  fmt::print("| setting | meaning | allowed |");
  for (const std::string_view preset : preset_names()) {
    fmt::print(" `{}` |", preset);
  }
  fmt::print("\n|---|---|---|");
  for (std::size_t i = 0; i < preset_names().size(); ++i) {
    fmt::print("---|");
  }
  fmt::print("\n");
  for (const SettingDoc& doc : setting_docs()) {
    fmt::print("| `{}` | {} | {} |", doc.name, doc.meaning, doc.allowed);
    for (const std::string& value : doc.presets) {
      fmt::print(" {} |", value);
    }
    fmt::print("\n");
  }
}

}  // namespace

void add_config(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* const command =
      app.add_subcommand("config", "Print the settings with their meaning, as TOML");
  command->add_option("--config", options->file, "start from this file");
  command->add_option("--set", options->set, "key=value, over the file (repeatable)");
  command->add_option("--axes", options->axes, "number of targets")->check(CLI::Range(1, 64));
  command->add_flag("--markdown", options->markdown, "the table of docs/settings.md instead");
  command->callback([options] {
    if (options->markdown) {
      print_markdown();
      return;
    }
    const ConfigFile file = options->file.empty() ? ConfigFile{} : read_config(options->file);
    print_toml(make_settings(file, options->set, options->axes));
  });
}

}  // namespace kelpie::cli
