// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "study/comparison.hpp"

namespace kelpie::report {

/// What R² has to differ by to be worth a word.
inline constexpr double kClearly = 0.01;

/// What follows from a comparison, a paragraph of plain text each: every axis by itself, then one
/// step ahead, then the settings that were tried. Requires a contest of kelpie, the first one.
std::vector<std::string> recommendation(const study::Comparison& comparison);

}  // namespace kelpie::report
