// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace kelpie::format {

/// Numbers and words as C99 has them, in double or in float.
class CText {
 public:
  explicit CText(bool single) : single_(single) {}

  const char* real() const { return single_ ? "float" : "double"; }

  /// The shortest constant that reads back to the same value. Throws InputError where it is
  /// out of the type's range.
  std::string number(double value) const;

  std::string bound(double value) const;  ///< The same, or the infinity of <math.h>.

  /// "{1.0, 2.0}"
  std::string list(std::span<const double> values) const;

 private:
  bool single_;
};

/// Any text as a string constant that may stand in a comment as well: plain ASCII, no line ends, no
/// trigraphs, nothing that opens or closes a comment, no $.
std::string c_string(std::string_view text);

/// Whether names in C can begin with it: letters, digits and underscores, first a letter.
bool can_begin_c_names(std::string_view text);

/// `text` with every word in it replaced by what stands beside it.
std::string replaced(std::string text, std::span<const std::pair<std::string, std::string>> words);

}  // namespace kelpie::format
