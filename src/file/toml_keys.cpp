// SPDX-License-Identifier: Apache-2.0
#include "file/toml_keys.hpp"

#include <algorithm>

#include "kelpie/core/error.hpp"

namespace kelpie::file {
namespace {

// Where the string ends that begins at `begin`: its last quote, or what breaks it off.
std::size_t end_of_string(std::string_view text, std::size_t begin) {
  const std::string three(3, text[begin]);
  const bool is_long = text.substr(begin).starts_with(three);
  for (std::size_t i = begin + (is_long ? 3 : 1); i < text.size(); ++i) {
    if (text[i] == '\\' && text[begin] == '"') {
      ++i;
    } else if (is_long ? text.substr(i).starts_with(three)
                       : text[i] == text[begin] || text[i] == '\n') {
      return is_long ? i + 2 : i;
    }
  }
  return text.size();
}

}  // namespace

void check_toml_keys(std::string_view text, const std::string& file) {
  constexpr std::size_t kMostParts = 16;
  std::size_t parts = 1;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"' || text[i] == '\'') {
      i = end_of_string(text, i);
    } else if (text[i] == '#') {
      i = std::min(text.find('\n', i), text.size() - 1);
      parts = 1;
    } else if (std::string_view("\n=,[]{}").find(text[i]) != std::string_view::npos) {
      parts = 1;
    } else if (text[i] == '.' && ++parts > kMostParts) {
      const auto line = 1 + std::ranges::count(text.substr(0, i), '\n');
      throw InputError({.file = file, .line = static_cast<std::size_t>(line)},
                       "a key of more than " + std::to_string(kMostParts) +
                           " parts with dots between them; no setting has one");
    }
  }
}

}  // namespace kelpie::file
