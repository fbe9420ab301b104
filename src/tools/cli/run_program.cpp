// SPDX-License-Identifier: Apache-2.0
#include "cli/run_program.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <iterator>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "chart/text_table.hpp"
#include "cli/output.hpp"
#include "core/text.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie::cli {
namespace {

constexpr int kFailed = 1;
constexpr int kBadInput = 2;
constexpr std::size_t kMostSaid = 2'000;  // bytes of an error

// The parser takes -1 for the largest number there is, and names no type for what it doesn't take.
void check_numbers(CLI::App& app) {
  const auto check = [](auto number, const std::string& kind) {
    return CLI::Validator(
        [=](const std::string& text) mutable {
          const char* const end = text.data() + text.size();
          const auto [at, error] = std::from_chars(text.data(), end, number);
          return error == std::errc() && at == end ? ""
                                                   : "'" + printable(text) + "' has to be " + kind;
        },
        "");
  };
  const CLI::Validator count = check(std::uint64_t{}, "a whole number, 0 or more, below 2^64");
  const CLI::Validator whole = check(int{}, "a whole number within ±2147483647");
  for (CLI::Option* const option : app.get_options()) {
    const std::string type = option->get_type_name();
    if (type.starts_with("UINT")) {
      option->check(count);
    } else if (type.starts_with("INT")) {
      option->check(whole);
    }
  }
  for (CLI::App* const command : app.get_subcommands({})) {
    check_numbers(*command);
  }
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* const option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) {
      names.push_back("--" + name);
    }
  }
  return names;
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* const command : visible_commands(app)) {
    names.push_back(command->get_name());
  }
  return names;
}

// The first word that no command and no option took, with the nearest that there is.
std::string unknown_word(const CLI::App& app) {
  const std::vector<CLI::App*> parsed = app.get_subcommands();
  for (const std::string& word : app.remaining()) {
    const std::string name = word.substr(0, word.find('='));
    if (name.starts_with("--")) {
      return "There is no option " + printable(name) + did_you_mean(name, option_names(app)) + "\n";
    }
    const std::vector<std::string> commands = command_names(app);
    if (parsed.empty() && !commands.empty() && !name.starts_with('-')) {
      return "There is no command '" + printable(name) + "'" + did_you_mean(name, commands) +
             "; there are " + join_text(commands, ", ") + "\n";
    }
  }
  return parsed.empty() ? "" : unknown_word(*parsed.front());
}

std::string failure_message(const CLI::App* app, const CLI::Error& error) {
  const std::string_view why = error.what();
  const std::string where_help_is = CLI::FailureMessage::simple(app, error).substr(why.size() + 1);
  const std::string unknown = unknown_word(*app);
  return (unknown.empty() ? printable(why, kMostSaid) + "\n" : unknown) + where_help_is;
}

// A command that does nothing by itself and was given nothing to do: its help, as for `kelpie`.
const CLI::App* idle_command(const CLI::App& app) {
  const CLI::App* last = &app;
  while (!last->get_subcommands().empty()) {
    last = last->get_subcommands().front();
  }
  const bool is_idle = last->get_require_subcommand_min() > 0 && app.remaining_size(true) == 0;
  return is_idle ? last : nullptr;
}

// What was said before an error appears before it.
int failed(int code, const std::exception& error) {
  static_cast<void>(std::fflush(streams().out));  // it fails already
  print_safely(streams().err, "kelpie: " + shortened(error.what(), kMostSaid) + "\n");
  return code;
}

constexpr std::size_t kColumn = 30;  // of the explanations, as CLI11 has it

// $COLUMNS, the terminal's width, or 80; no line is longer than can be read with ease.
std::size_t help_width() {
  constexpr std::size_t kLeast = 60;
  constexpr std::size_t kUsual = 80;
  constexpr std::size_t kMost = 100;
  winsize window{};
  double width = 0.0;
  const char* const columns = std::getenv("COLUMNS");  // NOLINT(concurrency-mt-unsafe)
  if (columns == nullptr || !parse_number(columns, width)) {
    const bool is_terminal =
        ioctl(::fileno(streams().out), TIOCGWINSZ, &window) == 0 && window.ws_col > 0;
    width = static_cast<double>(is_terminal ? window.ws_col : kUsual);
  }
  return static_cast<std::size_t>(std::clamp<double>(width, kLeast, kMost));
}

std::string in_lines(const std::string& text, std::size_t indentation) {
  return chart::wrapped(text, help_width() - indentation);
}

// Wrapped at the terminal's width; and `--help-all` in the form that help2man makes a manual page
// of: a heading in stars is a section, a line that ends in a colon with indented ones below a
// subsection.
class HelpFormat final : public CLI::Formatter {
 public:
  std::string make_option_desc(const CLI::Option* option) const override {
    return in_lines(Formatter::make_option_desc(option), kColumn);
  }

  std::string make_description(const CLI::App* app) const override {
    return in_lines(app->get_description(), 0) + "\n";
  }

  std::string make_subcommand(const CLI::App* command) const override {
    std::ostringstream line;
    CLI::detail::format_help(line, command->get_name(),
                             in_lines(command->get_description(), kColumn), kColumn);
    return line.str();
  }

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

void give_format(CLI::App& app, const std::shared_ptr<HelpFormat>& format) {
  app.formatter(format);
  for (CLI::App* const command : app.get_subcommands({})) {
    give_format(*command, format);
  }
}

void add_all(CLI::App& app, const Commands& commands) {
  app.require_subcommand(1);
  for (const auto add : commands) {
    add(app);
  }
  check_numbers(app);
}

// CLI11 takes the last word first.
void parse(CLI::App& app, const std::vector<std::string>& words) {
  std::vector<std::string> last_first(words.rbegin(), words.rend());
  if (!words.empty() && words.front() == "help") {
    last_first.back() = "--help";
    std::ranges::rotate(last_first, std::prev(last_first.end()));
  }
  app.parse(std::move(last_first));
}

// The parser prints what ended it: a help, or what the words lack.
int ended(const CLI::App& app, const CLI::Error& error) {
  std::ostringstream out;
  std::ostringstream err;
  const int code = app.exit(error, out, err);
  print_safely(streams().out, out.str());
  print_safely(streams().err, shortened(err.str(), kMostSaid));
  return code == 0 ? 0 : kBadInput;
}

}  // namespace

int run_program(const std::string& name, const std::string& meaning, const Commands& commands,
                const std::vector<std::string>& words, const Streams& streams) {
  const StreamGuard guard(streams);
  static_cast<void>(std::signal(SIGXFSZ, SIG_IGN));  // a write beyond the limit fails instead
  CLI::App app{meaning, name};
  try {
    app.set_version_flag("--version", name + " " KELPIE_VERSION);
    add_all(app, commands);
    app.failure_message(failure_message);
    try {
      parse(app, words);
    } catch (const CLI::RequiredError& error) {
      if (const CLI::App* const idle = idle_command(app)) {
        print_safely(streams.err, idle->help(idle == &app ? "" : app.get_name()));
        return kBadInput;
      }
      return ended(app, error);
    } catch (const CLI::ParseError& error) {
      if (ended(app, error) != 0) {
        return kBadInput;
      }
    }
    finish_output();
    return 0;
  } catch (const InputError& error) {
    return failed(kBadInput, error);
  } catch (const std::exception& error) {
    return failed(kFailed, error);
  }
}

void run_command(const Commands& commands, const std::vector<std::string>& words) {
  CLI::App app("kelpie", "kelpie");
  add_all(app, commands);
  try {
    parse(app, words);
  } catch (const CLI::ParseError& error) {
    throw InputError(std::string(trimmed(failure_message(&app, error))));
  }
}

std::vector<const CLI::App*> visible_commands(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* one) { return !one->get_group().empty(); });
}

void group_commands(CLI::App& app) {
  for (const auto& [group, names] : {std::pair("Every day", "inspect learn predict rollout live"),
                                     std::pair("Use of a model", "export simulate vehicle"),
                                     std::pair("Parameters of a vehicle", "identify plan"),
                                     std::pair("Many logs", "health compare tune study"),
                                     std::pair("Files", "convert memory play config completion")}) {
    const std::vector<std::string> all = split_text(names, ' ');
    for (CLI::App* const command : app.get_subcommands({})) {
      if (!command->get_group().empty() && std::ranges::count(all, command->get_name()) > 0) {
        command->group(group);
      }
    }
  }
}

void add_help(CLI::App& app) {
  give_format(app, std::make_shared<HelpFormat>());
  app.set_help_all_flag("--help-all", "Print the help of all commands and exit");
}

}  // namespace kelpie::cli
