// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kelpie::log {

/// Throws InputError (file, line, column).
[[noreturn]] void refuse_csv(const std::string& source, std::size_t line,
                             const std::string& message, const std::string& field = {});

/// What of a cell a message can show: short, and nothing that would steer a terminal.
std::string shown_cell(std::string_view cell);

/// The lines of a text, each without its end (LF, CRLF or CR), numbered from 1.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}

  bool next(std::string_view& line);
  std::size_t number() const { return number_; }

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

/// Cuts lines into cells.
class CellCutter {
 public:
  CellCutter(std::string source, char separator)
      : source_(std::move(source)), separator_(separator) {}

  char separator() const { return separator_; }
  /// The cells are views into the line, or into text kept here until the next call. Throws
  /// InputError (file, line) on a broken quotation.
  std::span<const std::string_view> cut(std::string_view line, std::size_t number);

 private:
  std::size_t cut_quoted(std::string_view rest, std::size_t quote, std::size_t number);

  std::string source_;
  char separator_;
  std::vector<std::string_view> cells_;
  std::string unquoted_;
};

/// Comma, semicolon or tab: the one that the header holds most of outside of quotes.
char separator_of(std::string_view header);

}  // namespace kelpie::log
