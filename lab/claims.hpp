// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "file/json.hpp"

namespace kelpie::lab {

/// The verdict on a claim.
enum class ClaimState : std::uint8_t { holds, in_part, fails, not_judged };

std::string_view finding_text(ClaimState finding);  ///< "holds", "holds in part", …

/// Measured figures, and the verdict that follows by the rule.
struct Judgement {
  std::string measured;
  ClaimState finding = ClaimState::not_judged;
};

/// A claim of the paper on a stream under a split.
struct Claim {
  std::string text;   ///< the claim in our words
  std::string rule;   ///< thresholds for "holds" and "holds in part"
  std::string where;  ///< "simulation, random split", and the learner unless "the paper"
  Judgement paper;    ///< of the paper's learner, or of another that the paper speaks of
  Judgement kelpie;   ///< of kelpie's default; empty where the claim is of another learner
};

/// The claims, grouped by subject, of the numbers of reproduction_document().
std::vector<Claim> claims_of(const file::Json& document);

double number_of(const file::Json& value);  ///< NaN for null.
/// Means of a row's R² at the end of a stage: over the seeds, and over seeds and axes.
double end_of(const file::Json& row, std::size_t stage, std::size_t axis);
double mean_end(const file::Json& row, std::size_t stage);
/// The row with the key, or null.
const file::Json* find_row(const file::Json& study, std::string_view key);

}  // namespace kelpie::lab
