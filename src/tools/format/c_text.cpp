// SPDX-License-Identifier: Apache-2.0
#include "format/c_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kelpie/core/error.hpp"

namespace kelpie::format {
namespace {

// A constant without a point would be an integer in C.
std::string with_point(const std::string& text) {
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

}  // namespace

std::string CText::number(double value) const {
  if (!std::isfinite(value)) {
    throw InputError("evaluating the model overflows a double");
  }
  if (!single_) {
    return with_point(fmt::format("{}", value));
  }
  const auto rounded = static_cast<float>(value);
  if (!std::isfinite(rounded)) {
    throw InputError("--float",
                     fmt::format("{} is out of range for float; export without --float", value));
  }
  return with_point(fmt::format("{}", rounded)) + "f";
}

std::string CText::bound(double value) const {
  return std::isfinite(value)
             ? number(value)
             : std::string(value < 0.0 ? "-" : "") + (single_ ? "HUGE_VALF" : "HUGE_VAL");
}

std::string CText::list(std::span<const double> values) const {
  std::string text;
  for (const double value : values) {
    text += (text.empty() ? "" : ", ") + number(value);
  }
  return "{" + text + "}";
}

std::string c_string(std::string_view text) {
  std::string constant = "\"";
  char before = '\0';
  for (const char letter : text) {
    const auto code = static_cast<unsigned char>(letter);
    const bool comment =
        (before == '*' && letter == '/') || (before == '/' && (letter == '*' || letter == '/'));
    if (letter == '"' || letter == '\\' || letter == '?') {
      constant += {'\\', letter};
    } else if (code < ' ' || code > '~' || letter == '$' || comment) {
      constant += fmt::format("\\{:03o}", code);
    } else {
      constant += letter;
    }
    before = letter;
  }
  return constant + "\"";
}

bool can_begin_c_names(std::string_view text) {
  const auto is_letter = [](char letter) {
    return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z');
  };
  return !text.empty() && is_letter(text.front()) && std::ranges::all_of(text, [&](char letter) {
    return is_letter(letter) || (letter >= '0' && letter <= '9') || letter == '_';
  });
}

std::string replaced(std::string text, std::span<const std::pair<std::string, std::string>> words) {
  for (const auto& [word, other] : words) {
    for (std::size_t at = text.find(word); at != std::string::npos;
         at = text.find(word, at + other.size())) {
      text.replace(at, word.size(), other);
    }
  }
  return text;
}

}  // namespace kelpie::format
