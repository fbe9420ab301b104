// SPDX-License-Identifier: Apache-2.0
#include "log/csv_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "kelpie/core/error.hpp"
#include "kelpie/core/text.hpp"

namespace kelpie::log {
namespace {

constexpr std::size_t kShownBytes = 40;

}  // namespace

void refuse_csv(const std::string& source, std::size_t line, const std::string& message,
                const std::string& field) {
  throw InputError({.file = source, .line = line, .field = field}, message);
}

std::string shown_cell(std::string_view cell) {
  std::size_t length = std::min(cell.size(), kShownBytes);
  const auto continues_letter = [&](std::size_t i) {  // in UTF-8
    return i < cell.size() && (static_cast<unsigned char>(cell[i]) & 0xC0U) == 0x80U;
  };
  while (length > 0 && continues_letter(length)) {
    --length;
  }
  std::string text(cell.substr(0, length));
  std::ranges::replace_if(
      text, [](unsigned char letter) { return letter < ' ' || letter == '\x7F'; }, '?');
  return text + (length < cell.size() ? "…" : "");
}

bool Lines::next(std::string_view& line) {
  if (rest_.empty()) {
    return false;
  }
  const std::size_t length = std::min(rest_.find_first_of("\r\n"), rest_.size());
  line = rest_.substr(0, length);
  rest_.remove_prefix(length);
  rest_.remove_prefix(rest_.starts_with("\r\n") ? 2 : std::min<std::size_t>(1, rest_.size()));
  ++number_;
  return true;
}

std::span<const std::string_view> CellCutter::cut(std::string_view line, std::size_t number) {
  cells_.clear();
  unquoted_.clear();
  unquoted_.reserve(line.size());  // views into it have to stay valid
  for (std::size_t first = 0; first <= line.size();) {
    const std::string_view rest = line.substr(first);
    const std::size_t start = rest.find_first_not_of(' ');
    if (start != std::string_view::npos && rest[start] == '"') {
      first += cut_quoted(rest, start, number);
    } else {
      const std::size_t length = std::min(rest.find(separator_), rest.size());
      cells_.push_back(trimmed(rest.substr(0, length)));
      first += length + 1;
    }
  }
  return cells_;
}

// Returns the length of the cell with its separator.
std::size_t CellCutter::cut_quoted(std::string_view rest, std::size_t quote, std::size_t number) {
  const std::size_t begin = unquoted_.size();
  std::size_t i = quote + 1;
  while (i < rest.size() && (rest[i] != '"' || rest.substr(i + 1).starts_with('"'))) {
    unquoted_ += rest[i];
    i += rest[i] == '"' ? 2 : 1;
  }
  if (i >= rest.size()) {
    refuse_csv(source_, number, "a quote is opened but not closed on this line");
  }
  const std::size_t after = std::min(rest.find_first_not_of(' ', i + 1), rest.size());
  if (after < rest.size() && rest[after] != separator_) {
    refuse_csv(
        source_, number,
        fmt::format("after a closing quote the next '{}' is due; a quote within a quoted cell "
                    "is written twice",
                    separator_));
  }
  cells_.push_back(trimmed(std::string_view(unquoted_).substr(begin)));
  return after + 1;
}

char separator_of(std::string_view header) {
  constexpr std::array<char, 3> kSeparators{',', ';', '\t'};
  std::array<std::size_t, kSeparators.size()> counts{};
  bool in_quotes = false;
  for (const char letter : header) {
    in_quotes = in_quotes != (letter == '"');
    for (std::size_t k = 0; k < kSeparators.size() && !in_quotes; ++k) {
      counts[k] += letter == kSeparators[k] ? 1 : 0;
    }
  }
  return kSeparators[static_cast<std::size_t>(std::ranges::max_element(counts) - counts.begin())];
}

}  // namespace kelpie::log
