// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "format/c_text.hpp"
#include "kelpie/motion/term_set.hpp"

namespace kelpie::format {

/// What the terms of a model may call of the mathematical library.
inline constexpr std::array<std::string_view, 4> kLibraryCalls{"sqrt", "sin", "cos", "pow"};

/// Physics terms as C. Names begin with $NAME, numbers are of type $REAL, library calls read $sqrt.
struct TermCode {
  std::string helpers;  ///< functions that the terms call
  std::string body;     ///< sets `phi` and, where it is not null, `slope` from `x`
  std::vector<std::pair<std::size_t, std::size_t>> slopes;  ///< term and column of every slope
};

/// The functions that this code calls, $NAME_abs and so on.
std::string c_helpers(const std::string& body);

TermCode code_of(const TermSet& terms, const CText& text);

}  // namespace kelpie::format
