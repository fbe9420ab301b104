// SPDX-License-Identifier: Apache-2.0
#include "log/named_commands.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "kelpie/core/text.hpp"
#include "motion/signal_names.hpp"

namespace kelpie::log {
namespace {

constexpr std::size_t kShownNames = 16;

bool is_number(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

// "rpm#" and "rpm12"; gives what follows the word.
std::optional<std::string> rest_of(std::string_view pattern, const std::string& word) {
  if (!pattern.ends_with('#')) {
    return word == pattern ? std::optional<std::string>("") : std::nullopt;
  }
  pattern.remove_suffix(1);
  const bool fits = word.starts_with(pattern) && is_number(word.substr(pattern.size()));
  return fits ? std::optional(word.substr(pattern.size())) : std::nullopt;
}

// A name taken apart.
struct NamedCommand {
  CommandName::Kind kind = CommandName::Kind::thrust;
  int rank = 0;
  std::string_view why;
  std::string stem;  // the words that make it a command's
  std::string tail;  // which one it is
};

void add_word(std::string& text, const std::string& word) {
  text += word.empty() ? "" : " " + word;
}

std::optional<NamedCommand> command_by_name(const CandidateColumn& column) {
  std::vector<std::string> words = words_of(column.name);
  if (!words.empty() && !column.topic.empty() &&
      (words.back() == "data" || words.back() == "value")) {
    words.pop_back();
  }
  const std::string whole = join_text(words, "_");
  NamedCommand command;
  bool is_one = false;
  const auto meet = [&](const CommandName& known) {
    command.kind = command.rank == 0 ? known.kind : std::max(command.kind, known.kind);
    command.rank = std::max(command.rank, known.rank);
    command.why = known.why;
    is_one = true;
  };
  for (const std::string& word : words) {
    if (std::ranges::find(known_other_words(), word) != known_other_words().end()) {
      return std::nullopt;
    }
    bool is_known = false;
    for (const CommandName& known : command_names()) {
      if (const std::optional<std::string> rest = rest_of(known.word, word); rest && !is_known) {
        meet(known);
        add_word(command.stem, word.substr(0, word.size() - rest->size()));
        add_word(command.tail, *rest);
        is_known = true;
      }
    }
    if (!is_known) {
      const bool is_field =
          std::ranges::find(known_command_fields(), word) != known_command_fields().end();
      add_word(is_field ? command.stem : command.tail, word);
    }
  }
  for (const CommandName& known : command_names()) {
    if (known.word.find('_') != std::string_view::npos && known.word == whole) {
      meet(known);
      command.tail = whole;
    }
  }
  return is_one ? std::optional(command) : std::nullopt;
}

struct CommandGroup {
  std::vector<CandidateColumn> columns;
  std::set<std::string> tails;
  CommandName::Kind kind = CommandName::Kind::thrust;
  int rank = 0;
  std::string why;
};

std::string names_text(const std::vector<CandidateColumn>& columns) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < columns.size() && k < kShownNames; ++k) {
    names.push_back(columns[k].name);
  }
  const std::size_t more = columns.size() - names.size();
  return join_text(names, ", ") + (more > 0 ? " and " + std::to_string(more) + " more" : "");
}

}  // namespace

std::vector<std::string> command_paths(const bag::TopicReport& topic) {
  std::vector<std::string> paths;
  const auto add = [&](const bag::FieldRange& field) {
    for (std::size_t k = 0; k < field.elements.size() && field.path.ends_with("[]"); ++k) {
      paths.push_back(field.path.substr(0, field.path.size() - 1) + std::to_string(k) + "]");
    }
    if (field.elements.empty()) {
      paths.push_back(field.path);
    }
  };
  const bool is_table = topic.name.empty() || topic.type.starts_with("matlab/");
  for (const std::string_view wanted : known_command_fields()) {
    for (const bag::FieldRange& field : topic.fields) {
      const std::string last = field.path.substr(field.path.rfind('.') + 1);
      if (!is_table && (last == wanted || last == std::string(wanted) + "[]")) {
        add(field);
      }
    }
    if (!paths.empty()) {
      return paths;
    }
  }
  for (const bag::FieldRange& field : topic.fields) {
    if (is_table || command_by_name({.name = field.path, .topic = topic.name})) {
      add(field);
    }
  }
  return paths;
}

std::vector<Candidate> named_commands(const std::vector<CandidateColumn>& columns) {
  std::map<std::pair<CommandName::Kind, std::string>, CommandGroup> groups;
  for (const CandidateColumn& column : columns) {
    if (velocity_by_name(column.name)) {
      continue;
    }
    if (const std::optional<NamedCommand> named = command_by_name(column)) {
      CommandGroup& group = groups[{named->kind, named->stem}];
      group.columns.push_back(column);
      group.tails.insert(named->tail);
      group.kind = named->kind;
      group.rank = std::max(group.rank, named->rank);
      group.why = named->why.empty() ? "by its name" : std::string(named->why);
    }
  }
  std::vector<Candidate> found;
  std::vector<CommandGroup> taken;  // the first reading
  for (auto& [key, group] : groups) {
    const bool is_rival = std::ranges::any_of(taken, [&](const CommandGroup& one) {
      return one.kind == group.kind && one.tails == group.tails && one.rank == group.rank;
    });
    taken.push_back(group);
    auto home = std::ranges::find(found, group.rank + 1, &Candidate::rank);
    if (is_rival || home == found.end()) {
      home = found.insert(found.end(), {.part = Part::commands,
                                        .what = {},
                                        .columns = {},
                                        .rank = group.rank + 1,
                                        .why = group.why});
    }
    home->columns.insert(home->columns.end(), group.columns.begin(), group.columns.end());
    home->what = names_text(home->columns);
  }
  return found;
}

}  // namespace kelpie::log
