// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "lab/reproduction.hpp"

namespace kelpie::lab {

/// The verdict on a claim.
enum class ClaimState : std::uint8_t { holds, in_part, fails, not_judged };

std::string_view finding_text(ClaimState finding);  ///< "holds", "holds in part", …

/// A claim of the paper on a stream under a split, with measured figures.
struct Claim {
  std::string paper;     ///< the claim in our words
  std::string rule;      ///< thresholds for "holds" and "holds in part"
  std::string where;     ///< "simulation, random split"
  std::string measured;  ///< our figures
  ClaimState finding = ClaimState::not_judged;
};

/// The claims, grouped by subject. Each verdict follows from the figures by the rule beside the
/// claim.
std::vector<Claim> claims_of(const Reproduction& result);

}  // namespace kelpie::lab
