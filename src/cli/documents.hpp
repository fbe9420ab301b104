// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

namespace kelpie::cli {

// The commands as they are defined, in words: the manual and the completions are made of this, and
// so can't forget an option.

/// What can be given where an option wants a value, as far as a shell can help with it.
enum class ValueKind {
  none,     ///< a flag
  text,     ///< anything
  choice,   ///< one of OptionDoc::choices
  file,     ///< type name FILE
  folder,   ///< type name FOLDER
  setting,  ///< type name SETTING: one of `kelpie config`, as key=value
};

/// An option or a positional argument, as its command defines it.
struct OptionDoc {
  std::vector<std::string> names;  ///< with their dashes; of a positional its bare name
  std::string value;               ///< what its value is called: "FILE", "INTEGER"; "" for a flag
  ValueKind kind = ValueKind::none;
  std::vector<std::string> choices;
  std::string meaning;
  std::string limits;    ///< "from 1 to 64"; "" where there are none
  std::string fallback;  ///< its value when it isn't given, where that is shown
  bool required = false;
  bool positional = false;
  bool repeatable = false;

  const std::string& name() const { return names.back(); }  ///< the long one
};

/// A subcommand; the first of a list is kelpie itself, with an empty name.
struct CommandDoc {
  std::string name;
  std::string meaning;
  std::vector<OptionDoc> options;  ///< positionals first
};

/// The manual page kelpie(1) in roff, ASCII.
std::string manual_page(std::span<const CommandDoc> commands, const std::string& version);

/// A script for bash, to be sourced or put where bash-completion looks.
std::string bash_completion(std::span<const CommandDoc> commands);

/// A script for zsh, to be sourced or put into its fpath as _kelpie.
std::string zsh_completion(std::span<const CommandDoc> commands);

}  // namespace kelpie::cli
