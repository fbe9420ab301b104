// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <string_view>

#include "cli/documents.hpp"
#include "kelpie/core/text.hpp"
#include "kelpie/model/settings.hpp"

namespace kelpie::cli {
namespace {

constexpr std::string_view kAnyFile = "FILE";  // among choices: or a file

// The choices without kAnyFile.
std::string choice_words(const OptionDoc& option) {
  std::vector<std::string> words = option.choices;
  std::erase(words, kAnyFile);
  return join_text(words, " ");
}

bool takes_file(const OptionDoc& option) {
  return option.kind == ValueKind::file || std::ranges::count(option.choices, kAnyFile) > 0;
}

std::string setting_words() {
  std::string words;
  for (const SettingDoc& setting : setting_docs()) {
    words += (words.empty() ? "" : " ") + setting.name + "=";
  }
  return words;
}

std::string command_words(std::span<const CommandDoc> commands) {
  std::string words;
  for (const CommandDoc& command : commands.subspan(1)) {
    words += (words.empty() ? "" : " ") + command.name;
  }
  return words;
}

std::string option_words(const CommandDoc& command) {
  std::string words;
  for (const OptionDoc& option : command.options) {
    for (const std::string& name : option.names) {
      if (!option.positional) {
        words += (words.empty() ? "" : " ") + name;
      }
    }
  }
  return words;
}

// What bash is to offer for a value; nothing for free text.
std::string bash_offer(const OptionDoc& option) {
  std::string offer;
  if (option.kind == ValueKind::choice) {
    offer += fmt::format(" _kelpie_words '{}';", choice_words(option));
  }
  if (option.kind == ValueKind::setting) {
    offer += fmt::format(" _kelpie_words '{}'; compopt -o nospace 2>/dev/null;", setting_words());
  }
  if (takes_file(option)) {
    offer += " _kelpie_paths -f;";
  }
  if (option.kind == ValueKind::folder) {
    offer += " _kelpie_paths -d;";
  }
  return offer;
}

constexpr std::string_view kBashHead = R"(# SPDX-License-Identifier: Apache-2.0
# Completion of kelpie's commands for bash, made by `kelpie completion bash`.

_kelpie_words() {
  local -a found
  mapfile -t found < <(compgen -W "$1" -- "$current")
  COMPREPLY+=("${found[@]}")
}

_kelpie_paths() {
  local -a found
  mapfile -t found < <(compgen "$1" -- "$current")
  COMPREPLY+=("${found[@]}")
  compopt -o filenames 2>/dev/null
}

_kelpie() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]} command='' i
  COMPREPLY=()
  for ((i = 1; i < COMP_CWORD; ++i)); do
    if [[ ${COMP_WORDS[i]} != -* ]]; then
      command=${COMP_WORDS[i]}
      break
    fi
  done
  # bash takes --option=value apart into three words.
  if [[ $current == '=' ]]; then
    current=''
  elif [[ $previous == '=' ]]; then
    previous=${COMP_WORDS[COMP_CWORD-2]}
  fi
  case "$command $previous" in
)";

// What zsh does with a value, behind the option's description.
std::string zsh_value(const OptionDoc& option) {
  switch (option.kind) {
    case ValueKind::none:
      return "";
    case ValueKind::choice: {
      const std::string words = "(" + choice_words(option) + ")";
      return takes_file(option)
                 ? ":value: _alternative 'word\\:word\\:" + words + "' 'file\\:file\\:_files'"
                 : ":value:" + words;
    }
    case ValueKind::file:
      return ":file:_files";
    case ValueKind::folder:
      return ":folder:_files -/";
    case ValueKind::setting:
      return fmt::format(":setting:compadd -S \"\" -- {}", setting_words());
    case ValueKind::text:
      break;
  }
  return ":" + option.value + ": ";
}

// Text inside '…[…]' of _arguments.
std::string zsh_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '\'') {
      out += "'\\''";
    } else if (c == '[' || c == ']' || c == ':' || c == '\\') {
      out += std::string("\\") + c;
    } else {
      out += c;
    }
  }
  return out;
}

std::string zsh_quoted_value(const OptionDoc& option) {
  std::string out;
  for (const char c : zsh_value(option)) {
    out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return out;
}

std::string zsh_arguments(const CommandDoc& command) {
  std::string text = "      _arguments";
  int place = 0;
  for (const OptionDoc& option : command.options) {
    for (const std::string& name : option.names) {
      text += option.positional
                  ? fmt::format(" \\\n        '{}{}'", ++place, zsh_quoted_value(option))
                  : fmt::format(" \\\n        '{}{}[{}]{}'", option.repeatable ? "*" : "", name,
                                zsh_text(option.meaning), zsh_quoted_value(option));
    }
  }
  return text + "\n";
}

}  // namespace

std::string bash_completion(std::span<const CommandDoc> commands) {
  std::string script(kBashHead);
  std::string rest;
  for (const CommandDoc& command : commands) {
    std::string positional;
    for (const OptionDoc& option : command.options) {
      if (option.positional) {
        positional += bash_offer(option);
      } else if (option.kind != ValueKind::none) {
        script += fmt::format("    '{} {}'){} return ;;\n", command.name, option.name(),
                              bash_offer(option));
      }
    }
    if (command.name.empty()) {
      positional = fmt::format(" _kelpie_words '{}';", command_words(commands));
    }
    rest += fmt::format(
        "    '{}')\n      if [[ $current == -* ]]; then _kelpie_words '{}'; else{} :; fi ;;\n",
        command.name, option_words(command), positional);
  }
  return script + "  esac\n  case \"$command\" in\n" + rest + "  esac\n}\n\n" +
         "complete -F _kelpie kelpie\n";
}

std::string zsh_completion(std::span<const CommandDoc> commands) {
  std::string script =
      "#compdef kelpie\n# SPDX-License-Identifier: Apache-2.0\n"
      "# Completion of kelpie's commands for zsh, made by `kelpie completion zsh`.\n\n"
      "_kelpie() {\n  local state line\n  local -a commands=(\n";
  std::string cases;
  for (const CommandDoc& command : commands.subspan(1)) {
    script += fmt::format("    '{}:{}'\n", command.name, zsh_text(command.meaning));
    cases += fmt::format("    {})\n{}      ;;\n", command.name, zsh_arguments(command));
  }
  script += "  )\n  _arguments -C";
  for (const OptionDoc& option : commands.front().options) {
    for (const std::string& name : option.names) {
      script += fmt::format(" \\\n    '{}[{}]'", name, zsh_text(option.meaning));
    }
  }
  return script +
         " \\\n    '1:command:->command' \\\n    '*::argument:->argument'\n"
         "  if [[ $state == command ]]; then\n    _describe command commands\n    return\n  fi\n"
         "  case $words[1] in\n" +
         cases +
         "  esac\n}\n\n"
         "if [[ $funcstack[1] == _kelpie ]]; then\n  _kelpie \"$@\"\nelse\n"
         "  compdef _kelpie kelpie\nfi\n";
}

}  // namespace kelpie::cli
