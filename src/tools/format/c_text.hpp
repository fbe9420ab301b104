// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace kelpie::format {

/// Numbers as constants of C99, in double or float.
class CText {
 public:
  explicit CText(bool single) : single_(single) {}

  const char* real() const { return single_ ? "float" : "double"; }

  /// The shortest constant that reads back to the same value. Throws InputError on a number out of
  /// range for the type.
  std::string number(double value) const;

  std::string bound(double value) const;  ///< As number(), or an infinity of <math.h>.

  /// "{1.0, 2.0}"
  std::string list(std::span<const double> values) const;

 private:
  bool single_;
};

/// Text as a string constant, also valid inside a comment: plain ASCII, no line ends, trigraphs,
/// comment delimiters or $.
std::string c_string(std::string_view text);

/// Whether `text` can begin names in C: letters, digits and underscores, a letter first.
bool can_begin_c_names(std::string_view text);

/// `text` with each occurrence of a first word replaced by the second of the pair.
std::string replaced(std::string text, std::span<const std::pair<std::string, std::string>> words);

}  // namespace kelpie::format
