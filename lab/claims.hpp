// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "lab/reproduction.hpp"

namespace kelpie::lab {

/// What became of a claim.
enum class ClaimState : std::uint8_t { holds, in_part, fails, not_judged };

std::string_view finding_text(ClaimState finding);  ///< "holds", "holds in part", …

/// One claim of the paper on one stream under one split, and what was measured of it.
struct Claim {
  std::string paper;     ///< the claim in our words
  std::string rule;      ///< the figures from which it holds, and from which it holds in part
  std::string where;     ///< "simulation, random split"
  std::string measured;  ///< our figures
  ClaimState finding = ClaimState::not_judged;
};

/// All claims, those on the same thing one after the other. Every verdict is computed from the
/// numbers by the rule that stands beside it.
std::vector<Claim> claims_of(const Reproduction& result);

}  // namespace kelpie::lab
