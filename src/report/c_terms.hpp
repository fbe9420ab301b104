// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "c_text.hpp"
#include "kelpie/model/term_set.hpp"

namespace kelpie {

/// Physics terms as C. Names begin with $NAME, numbers are of type $REAL.
struct TermCode {
  std::string helpers;  ///< functions that the terms call
  std::string body;     ///< sets `phi` and, where it is not null, `slope` from `x`
  std::vector<std::pair<std::size_t, std::size_t>> slopes;  ///< term and column of every slope
  std::vector<std::string> library;                         ///< what it calls beside exp
};

/// The functions of these names, $NAME_abs and so on; others are passed over.
std::string c_helpers(const std::set<std::string>& names);

TermCode code_of(const TermSet& terms, const CText& text);

}  // namespace kelpie
