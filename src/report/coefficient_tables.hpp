// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "chart/text_table.hpp"
#include "study/result.hpp"

namespace kelpie::report {

/// One table per axis that has coefficients: term, coefficient, its unit, what it was at half of
/// the stream and by how much it changed since, and its effect.
std::vector<chart::TextTable> coefficient_tables(const study::StreamResult& result);

/// What their columns mean, in a sentence or two.
inline constexpr std::string_view kCoefficientNote =
    "Change: since half of the stream. Effect: coefficient times the term's root mean square over "
    "the training rows, in the target's unit. What the kernel explains beside the terms is in none "
    "of these numbers.";

}  // namespace kelpie::report
