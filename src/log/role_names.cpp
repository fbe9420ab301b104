// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>

#include "kelpie/core/text.hpp"
#include "kelpie/motion/states.hpp"
#include "log/candidates.hpp"
#include "motion/signal_names.hpp"

namespace kelpie::log {
namespace {

bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0;
}

bool is_digit(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

// What stands between brackets: "x,y,z", "1..8" or, of an index, "0..3".
std::vector<std::string> choices(std::string_view text) {
  const std::size_t dots = text.find("..");
  if (dots == std::string_view::npos) {
    return split_text(text, ',');
  }
  std::vector<std::string> numbers;
  const int last = std::stoi(std::string(text.substr(dots + 2)));
  for (int number = std::stoi(std::string(text.substr(0, dots))); number <= last; ++number) {
    numbers.push_back(std::to_string(number));
  }
  return numbers;
}

}  // namespace

std::vector<std::string> expanded(std::string_view fields) {
  const std::size_t begin = fields.find_first_of("{[");
  if (begin == std::string_view::npos) {
    return {std::string(fields)};
  }
  const bool is_index = fields[begin] == '[';
  const std::size_t end = fields.find(is_index ? ']' : '}', begin);
  std::vector<std::string> all;
  for (const std::string& choice : choices(fields.substr(begin + 1, end - begin - 1))) {
    for (const std::string& rest : expanded(fields.substr(end + 1))) {
      std::string one(fields.substr(0, begin));
      one += is_index ? "[" + choice + "]" : choice;
      all.push_back(one + rest);
    }
  }
  return all;
}

std::vector<std::string> words_of(std::string_view name) {
  name = trimmed(name);
  if (const std::size_t bracket = name.find_last_of("[(");
      bracket != std::string_view::npos && bracket > 0 && !is_digit(name.substr(bracket + 1, 1))) {
    name = name.substr(0, bracket);
  }
  std::vector<std::string> words(1);
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto c = static_cast<unsigned char>(name[i]);
    const bool is_of_word = is_letter(name[i]) || is_digit(name.substr(i, 1)) || c >= 0x80;
    const bool begins =
        std::isupper(c) != 0 && i > 0 && std::islower(static_cast<unsigned char>(name[i - 1])) != 0;
    if ((!is_of_word || begins) && !words.back().empty()) {
      words.emplace_back();
    }
    if (is_of_word) {
      words.back() += static_cast<char>(std::tolower(c));
    }
  }
  if (words.back().empty()) {
    words.pop_back();
  }
  return words;
}

std::optional<std::size_t> velocity_by_name(std::string_view name) {
  const std::string words = join_text(words_of(name), "_");
  if (const std::optional<std::size_t> likely = likely_velocity_axis(words)) {
    return likely;
  }
  const std::optional<std::size_t> axis = velocity_axis(words);
  return axis ? axis : velocity_axis(name);
}

}  // namespace kelpie::log
