// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include "cli/commands.hpp"

namespace kelpie::cli {
namespace {

// `--help-all` in the form that help2man makes a manual page of: a heading in stars is a section, a
// line that ends in a colon with indented ones below a subsection.
class HelpFormat final : public CLI::Formatter {
 public:
  std::string make_subcommands(const CLI::App* app, CLI::AppFormatMode mode) const override {
    if (mode == CLI::AppFormatMode::Normal) {
      return Formatter::make_subcommands(app, mode);
    }
    std::string text = "\n*Commands*\n";
    for (const CLI::App* const command : visible_commands(*app)) {
      text += section(*command, app->get_name());
    }
    return text;
  }

 private:
  std::string section(const CLI::App& command, const std::string& before) const {
    const std::string name = before + " " + command.get_name();
    const std::vector<const CLI::App*> tasks = visible_commands(command);
    if (!tasks.empty()) {
      std::string text;
      for (const CLI::App* const task : tasks) {
        text += section(*task, name);
      }
      return text;
    }
    const std::string usage = make_usage(&command, name);
    std::string text = "\n" + usage.substr(usage.find(name), usage.find('\n') - usage.find(name)) +
                       ":\n  " + command.get_description() + "\n\n";
    for (const bool positional : {true, false}) {
      for (const CLI::Option* const option : command.get_options()) {
        if (option->get_positional() == positional && option != command.get_help_ptr()) {
          text += make_option(option, positional);
        }
      }
    }
    return text;
  }
};

}  // namespace

std::vector<const CLI::App*> visible_commands(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* one) { return !one->get_group().empty(); });
}

void add_help(CLI::App& app) {
  app.formatter(std::make_shared<HelpFormat>());
  app.set_help_all_flag("--help-all", "Print the help of all commands and exit");
}

}  // namespace kelpie::cli
