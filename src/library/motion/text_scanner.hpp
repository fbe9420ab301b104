// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>
#include <system_error>

namespace kelpie {

/// Reads a text from left to right, for the parsers of expressions and units. Spaces between
/// symbols are skipped.
class TextScanner {
 protected:
  explicit TextScanner(std::string_view text) : text_(text) {}  ///< The text outlives the scanner.

  bool at_end() {
    while (position_ < text_.size() && text_[position_] == ' ') {
      ++position_;
    }
    return position_ == text_.size();
  }

  /// Moves past `wanted`, if it is next.
  bool take(char wanted) {
    if (at_end() || text_[position_] != wanted) {
      return false;
    }
    ++position_;
    return true;
  }

  /// Moves past a finite number. No number may follow: then nothing moves.
  std::optional<double> take_number() {
    double value = 0.0;
    const char* const start = text_.data() + position_;
    const auto [end, error] = std::from_chars(start, text_.data() + text_.size(), value);
    if (error != std::errc{} || !std::isfinite(value)) {
      return std::nullopt;
    }
    position_ += static_cast<std::size_t>(end - start);
    return value;
  }

  std::string_view text_;
  std::size_t position_ = 0;
};

}  // namespace kelpie
