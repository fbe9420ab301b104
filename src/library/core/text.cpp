// SPDX-License-Identifier: Apache-2.0
#include "core/text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <numeric>

#include "kelpie/core/error.hpp"

namespace kelpie {
namespace {

constexpr const char* kBlanks = " \t\r";  // \r: of line ends from Windows

char lower(char letter) {
  return static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
}

// Bytes of the letter in UTF-8 at the beginning of a text; 0: none, or none to be shown.
std::size_t letter_bytes(std::string_view text) {
  constexpr std::array<char32_t, 5> kLeast{0, 0, 0x80, 0x800, 0x10000};  // no longer than needed
  const auto lead = static_cast<unsigned char>(text.front());
  const std::size_t bytes = lead < 0x80 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
  if ((lead >= 0x80 && lead < 0xC2) || lead > 0xF4 || text.size() < bytes) {
    return 0;
  }
  char32_t letter = bytes == 1 ? lead : lead & (0xFFU >> (bytes + 1));
  for (const char next : text.substr(1, bytes - 1)) {
    if ((static_cast<unsigned char>(next) & 0xC0U) != 0x80U) {
      return 0;
    }
    letter = letter << 6U | (static_cast<unsigned char>(next) & 0x3FU);
  }
  const auto is_among = [&](char32_t first, char32_t last) {
    return first <= letter && letter <= last;
  };
  const bool is_none = letter < kLeast.at(bytes) || is_among(0xD800, 0xDFFF) || letter > 0x10FFFF;
  // Of lines, terminals, directions of writing.
  const bool is_control = letter < ' ' || is_among(0x7F, 0x9F) || letter == 0x61C ||
                          is_among(0x200E, 0x200F) || is_among(0x2028, 0x202E) ||
                          is_among(0x2066, 0x2069);
  return is_none || is_control ? 0 : bytes;
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) {
    return {};
  }
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::vector<std::string> split_text(std::string_view text, char separator) {
  std::vector<std::string> parts;
  std::size_t first = 0;
  while (true) {
    const std::size_t end = std::min(text.find(separator, first), text.size());
    parts.emplace_back(trimmed(text.substr(first, end - first)));
    if (end == text.size()) {
      return parts;
    }
    first = end + 1;
  }
}

std::string join_text(std::span<const std::string> parts, std::string_view separator) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i > 0) {
      text += separator;
    }
    text += parts[i];
  }
  return text;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (lower(a[i]) == lower(b[j]) ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

std::string printable(std::string_view text, std::size_t most) {
  std::string shown;
  for (std::size_t letters = 0; !text.empty(); ++letters) {
    if (letters == most) {
      return shown + "…";
    }
    const std::size_t bytes = letter_bytes(text);
    shown += bytes == 0 ? "?" : text.substr(0, bytes);
    text.remove_prefix(std::max<std::size_t>(bytes, 1));
  }
  return shown;
}

std::string shortened(std::string_view text, std::size_t most) {
  if (text.size() <= most) {
    return std::string(text);
  }
  const auto is_within_letter = [&](std::size_t at) {
    return at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U;
  };
  std::size_t head = most / 2;
  std::size_t tail = text.size() - most / 2;
  for (; head > 0 && is_within_letter(head); --head) {
  }
  for (; is_within_letter(tail); ++tail) {
  }
  return std::string(text.substr(0, head)) + " … " + std::string(text.substr(tail));
}

std::string did_you_mean(std::string_view word, std::span<const std::string> candidates) {
  constexpr std::size_t kLongest = 200;  // longer words are no slip of a key, and cost too much
  if (word.size() > kLongest) {
    return "";
  }
  const std::string* nearest = nullptr;
  std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    if (candidate.size() > kLongest) {
      continue;
    }
    if (const std::size_t distance = edit_distance(word, candidate); distance < least) {
      least = distance;
      nearest = &candidate;
    }
  }
  return nearest == nullptr ? "" : " (did you mean '" + *nearest + "'?)";
}

std::string unknown_name(std::string_view name, std::string_view kind,
                         std::span<const std::string> known) {
  std::string text = "'" + printable(name) + "' is no " + std::string(kind);
  text += did_you_mean(name, known);
  return known.empty() ? text : text + "; there are " + join_text(known, ", ");
}

std::size_t require_name(std::string_view field, std::string_view name, std::string_view kind,
                         std::span<const std::string> known) {
  const auto found = std::ranges::find(known, name);
  if (found == known.end()) {
    throw InputError(field, unknown_name(name, kind, known));
  }
  return static_cast<std::size_t>(found - known.begin());
}

std::string without_brackets(const std::string& host) {
  return host.starts_with('[') && host.ends_with(']') ? host.substr(1, host.size() - 2) : host;
}

bool parse_number(std::string_view text, double& value) {
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') {
    text.remove_prefix(1);
  }
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc{} && stop == end && !text.empty();
}

std::string short_number(double value) {
  std::array<char, 32> text{};
  char* const end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 4)
          .ptr;
  return {text.data(), end};
}

}  // namespace kelpie
