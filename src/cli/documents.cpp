// SPDX-License-Identifier: Apache-2.0
#include "cli/documents.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <memory>

#include "cli/commands.hpp"
#include "kelpie/core/text.hpp"

namespace kelpie::cli {
namespace {

// What CLI11 says of a range or sign, as a reader would.
std::string limits_text(const std::string& rule) {
  if (rule == "POSITIVE") {
    return "above 0";
  }
  if (rule == "NONNEGATIVE") {
    return "not below 0";
  }
  const std::size_t open = rule.find('[');
  const std::size_t dash = rule.find(" - ");
  if (open == std::string::npos || dash == std::string::npos) {
    return rule;
  }
  const std::size_t low = open + 1;
  const std::size_t high = dash + 3;
  return "from " + rule.substr(low, dash - low) + " to " +
         rule.substr(high, rule.size() - 1 - high);
}

// The type as CLI11 has it, "TEXT:{receive,header}" or "UINT:INT in [1 - 64]", taken apart.
void read_type(const std::string& type, OptionDoc& doc) {
  const std::size_t brace = type.find('{');
  if (brace != std::string::npos) {
    doc.kind = ValueKind::choice;
    doc.choices = split_text(type.substr(brace + 1, type.find('}') - brace - 1), ',');
    doc.value = join_text(doc.choices, "|");
    return;
  }
  const std::size_t colon = type.find(':');
  const std::string base = type.substr(0, colon);
  doc.kind = base == "FILE"      ? ValueKind::file
             : base == "FOLDER"  ? ValueKind::folder
             : base == "SETTING" ? ValueKind::setting
                                 : ValueKind::text;
  doc.value = base == "UINT" || base == "INT" ? "INTEGER" : base == "FLOAT" ? "NUMBER" : base;
  doc.limits = colon == std::string::npos ? "" : limits_text(type.substr(colon + 1));
}

OptionDoc describe_option(const CLI::Option& option) {
  OptionDoc doc;
  doc.positional = option.get_positional();
  if (doc.positional) {
    doc.names.push_back(option.get_name(true));
  }
  for (const std::string& name : option.get_snames()) {
    doc.names.push_back("-" + name);
  }
  for (const std::string& name : option.get_lnames()) {
    doc.names.push_back("--" + name);
  }
  doc.meaning = option.get_description();
  doc.required = option.get_required();
  if (option.get_items_expected_max() > 0) {
    read_type(option.get_type_name(), doc);
    doc.fallback = option.get_default_str();
    doc.repeatable = option.get_expected_max() > 1;
  }
  return doc;
}

CommandDoc describe_command(const CLI::App& command) {
  CommandDoc doc{.name = command.get_name(), .meaning = command.get_description(), .options = {}};
  for (const CLI::Option* const option : command.get_options()) {
    doc.options.push_back(describe_option(*option));
  }
  std::ranges::stable_partition(doc.options,
                                [](const OptionDoc& option) { return option.positional; });
  return doc;
}

// A command of several tasks, "memory list FILE": the task is its first positional.
void describe_tasks(const CLI::App& command, CommandDoc& doc) {
  OptionDoc task;
  task.names = {"task"};
  task.kind = ValueKind::choice;
  task.required = true;
  task.positional = true;
  std::vector<OptionDoc> rest;
  for (const CLI::App* const one : command.get_subcommands(nullptr)) {
    task.choices.push_back(one->get_name());
    task.meaning +=
        (task.meaning.empty() ? "" : "; ") + one->get_name() + ": " + one->get_description();
    std::vector<OptionDoc> options = describe_command(*one).options;
    std::erase_if(options, [](const OptionDoc& option) { return !option.positional; });
    if (options.size() > rest.size()) {
      rest = std::move(options);
    }
  }
  if (!task.choices.empty()) {
    rest.insert(rest.begin(), std::move(task));
    doc.options.insert(doc.options.begin(), rest.begin(), rest.end());
  }
}

std::vector<CommandDoc> describe(const CLI::App& app) {
  std::vector<CommandDoc> commands{describe_command(app)};
  commands.front().name.clear();
  for (const CLI::App* const command : app.get_subcommands(nullptr)) {
    commands.push_back(describe_command(*command));
    describe_tasks(*command, commands.back());
  }
  return commands;
}

}  // namespace

void add_manual(CLI::App& app) {
  CLI::App* const command =
      app.add_subcommand("manual", "Print the manual page, as in kelpie manual | man -l -");
  command->callback([&app] { fmt::print("{}", manual_page(describe(app), KELPIE_VERSION)); });
}

void add_completion(CLI::App& app) {
  auto shell = std::make_shared<std::string>();
  CLI::App* const command = app.add_subcommand(
      "completion",
      "Print a script that completes commands, as in source <(kelpie completion bash)");
  command->add_option("shell", *shell, "for which shell")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh"}));
  command->callback([&app, shell] {
    const std::vector<CommandDoc> commands = describe(app);
    fmt::print("{}", *shell == "bash" ? bash_completion(commands) : zsh_completion(commands));
  });
}

}  // namespace kelpie::cli
