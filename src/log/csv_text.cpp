// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <iterator>
#include <string_view>
#include <vector>

#include "file/atomic_file.hpp"
#include "log/csv.hpp"

namespace kelpie::log {
namespace {

std::string quoted_if_needed(std::string_view text) {
  if (text.find_first_of(",;\t\"# ") == std::string_view::npos) {
    return std::string(text);
  }
  std::string quoted = "\"";
  for (const char letter : text) {
    quoted.append(letter == '"' ? 2 : 1, letter);
  }
  return quoted + '"';
}

}  // namespace

std::string csv_text(const Table& table) {
  fmt::memory_buffer text;
  std::vector<std::size_t> passed(table.columns.size(), 0);  // of each column's words
  const auto word_at = [&](std::size_t column, std::size_t row) -> const std::string* {
    if (!table.has_text(column)) {
      return nullptr;
    }
    const auto& words = table.texts[column].words;
    const bool is_next = passed[column] < words.size() && words[passed[column]].first == row;
    return is_next ? &words[passed[column]++].second : nullptr;
  };
  const auto out = std::back_inserter(text);
  for (std::size_t column = 0; column < table.names.size(); ++column) {
    fmt::format_to(out, "{}{}", column > 0 ? "," : "", quoted_if_needed(table.names[column]));
  }
  text.push_back('\n');
  for (std::size_t row = 0; row < table.rows(); ++row) {
    for (std::size_t column = 0; column < table.columns.size(); ++column) {
      fmt::format_to(out, "{}", column > 0 ? "," : "");
      if (const std::string* const word = word_at(column, row)) {
        fmt::format_to(out, "{}", quoted_if_needed(*word));
      } else {
        fmt::format_to(out, "{}", table.columns[column][row]);
      }
    }
    text.push_back('\n');
  }
  return {text.data(), text.size()};
}

void write_csv(const std::filesystem::path& file, const Table& table) {
  file::write_file_whole(file, csv_text(table));
}

}  // namespace kelpie::log
