// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cctype>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/output.hpp"
#include "core/text.hpp"
#include "kelpie/model/settings.hpp"

namespace kelpie::cli {
namespace {

// What can stand at the end of the line, one offer a line: a word, a tab and its meaning, or one of
// these two.
constexpr std::string_view kFiles = ":files";
constexpr std::string_view kFolders = ":folders";

constexpr std::string_view kBash = R"(# SPDX-License-Identifier: Apache-2.0
# Completion of kelpie's commands for bash; kelpie itself says what can follow.
_kelpie() {
  local current=${COMP_WORDS[COMP_CWORD]#=} offer
  local -a paths
  COMPREPLY=()
  while IFS= read -r offer; do
    case $offer in
      :files | :folders)
        [[ $offer == :files ]] && offer=-f || offer=-d
        mapfile -t paths < <(compgen "$offer" -- "$current")
        COMPREPLY+=("${paths[@]}")
        compopt -o filenames 2>/dev/null ;;
      *)
        COMPREPLY+=("${offer%%$'\t'*}")
        [[ $offer == *[=:] ]] && compopt -o nospace 2>/dev/null ;;
    esac
  done < <("$1" complete -- "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)
}
complete -F _kelpie kelpie
)";

constexpr std::string_view kZsh = R"(#compdef kelpie
# SPDX-License-Identifier: Apache-2.0
# Completion of kelpie's commands for zsh; kelpie itself says what can follow.
_kelpie() {
  local offer
  local -a offers
  compset -P '--*='
  for offer in "${(@f)$($words[1] complete -- "${(@)words[2,CURRENT]}" 2>/dev/null)}"; do
    case $offer in
      :files) _files ;;
      :folders) _files -/ ;;
      *[=:]) compadd -S '' -- "$offer" ;;
      ?*) offers+=("${offer/$'\t'/:}") ;;
    esac
  done
  (( $#offers )) && _describe kelpie offers
}
if [[ $funcstack[1] == _kelpie ]]; then _kelpie "$@"; else compdef _kelpie kelpie; fi
)";

// The line's words as the program will get them, but with an option and its value apart: bash gives
// --option=value as three words, zsh as one.
std::vector<std::string> taken_apart(const std::vector<std::string>& line) {
  std::vector<std::string> words;
  bool joined = false;
  for (const std::string& word : line) {
    if (joined || (word == "=" && !words.empty())) {
      words.back() += word;
    } else {
      words.push_back(word);
    }
    joined = word == "=";
  }
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::size_t equals = words[i].find('=');
    if (words[i].starts_with("--") && equals != std::string::npos) {
      words.insert(words.begin() + static_cast<std::ptrdiff_t>(i) + 1, words[i].substr(equals + 1));
      words[i].resize(equals);
    }
  }
  return words;
}

class Offers {
 public:
  explicit Offers(std::string current) : current_(std::move(current)) {}

  void word(const std::string& word, const std::string& meaning = "") const {
    if (word.starts_with(current_)) {
      say("{}{}{}\n", word, meaning.empty() ? "" : "\t", meaning);
    }
  }

  // By the name of its type as CLI11 has it: FILE, FOLDER, SETTING, {one,of,FILE}, TEXT:{one,two}.
  // Other words in capitals stand for what only the user knows.
  void value(const CLI::Option& option) const {
    const std::string full = option.get_type_name();
    const std::string type = full.substr(0, full.find(':'));
    const std::size_t brace = full.find('{');
    if (type == "SETTING") {
      for (const SettingText& setting : setting_docs()) {
        word(setting.name + "=");
      }
    } else if (type == "FOLDER") {
      say("{}\n", kFolders);
    } else if (brace != std::string::npos) {
      for (const std::string& choice :
           split_text(full.substr(brace + 1, full.find('}') - brace - 1), ',')) {
        if (choice == "FILE") {
          say("{}\n", kFiles);
        } else if (std::isupper(static_cast<unsigned char>(choice.front())) == 0) {
          const std::size_t colon = choice.find(':');  // column:NAME: the name is the user's
          word(colon == std::string::npos ? choice : choice.substr(0, colon + 1));
        }
      }
    } else if (type == "FILE") {
      say("{}\n", kFiles);
    }
  }

  void options(const CLI::App& command) const {
    for (const CLI::Option* const option : command.get_options()) {
      for (const std::string& name : option->get_lnames()) {
        word("--" + name, option->get_description());
      }
    }
  }

  void commands(const CLI::App& command) const {
    for (const CLI::App* const one : visible_commands(command)) {
      word(one->get_name(), one->get_description());
    }
  }

  bool wants_option() const { return current_.starts_with('-'); }

 private:
  std::string current_;
};

void complete(const CLI::App& app, const std::vector<std::string>& line) {
  std::vector<std::string> words = taken_apart(line);
  if (words.empty()) {
    return;
  }
  const Offers offers(words.back());
  words.pop_back();
  const CLI::App* command = &app;
  const CLI::Option* waiting = nullptr;  // for its value
  std::size_t place = 0;
  for (const std::string& word : words) {
    if (waiting != nullptr) {
      waiting = nullptr;
    } else if (word.starts_with('-')) {
      const CLI::Option* const option = command->get_option_no_throw(word);
      waiting = option != nullptr && option->get_items_expected_max() > 0 ? option : nullptr;
    } else {
      const std::vector<const CLI::App*> commands = visible_commands(*command);
      const auto found = std::ranges::find(commands, word, &CLI::App::get_name);
      if (found != commands.end()) {
        command = *found;
      } else {
        ++place;
      }
    }
  }
  if (waiting != nullptr) {
    return offers.value(*waiting);
  }
  if (offers.wants_option()) {
    return offers.options(*command);
  }
  offers.commands(*command);
  std::vector<const CLI::Option*> positionals =
      command->get_options([](const CLI::Option* option) { return option->get_positional(); });
  if (!positionals.empty()) {
    offers.value(*positionals[std::min(place, positionals.size() - 1)]);
  }
}

}  // namespace

void add_completion(CLI::App& app) {
  auto shell = std::make_shared<std::string>();
  CLI::App* const script = app.add_subcommand(
      "completion",
      "Print a script that completes commands, as in source <(kelpie completion bash)");
  script->add_option("shell", *shell, "for which shell")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh"}));
  script->callback([shell] { say("{}", *shell == "bash" ? kBash : kZsh); });

  add_examples(script, "completion bash > ~/.local/share/bash-completion/completions/kelpie",
               "completion zsh > ~/.zfunc/_kelpie");

  // What the scripts ask; in no help.
  auto words = std::make_shared<std::vector<std::string>>();
  CLI::App* const asked = app.add_subcommand("complete")->group("");
  asked->add_option("words", *words)->required();
  asked->callback([&app, words] { complete(app, *words); });
}

}  // namespace kelpie::cli
