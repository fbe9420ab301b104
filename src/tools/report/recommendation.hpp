// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "study/comparison.hpp"

namespace kelpie::report {

/// A conclusion, as a paragraph of plain text.
struct Advice {
  std::string text;
  bool is_news = true;  ///< beside the table and settings_advice(); not where kelpie is the best
};

/// The conclusions of a comparison: each axis, then predictions a step ahead, then the tried
/// settings. Requires kelpie as the first contest.
std::vector<Advice> all_advice(const study::Comparison& comparison);

/// The texts of all_advice().
std::vector<std::string> recommendation(const study::Comparison& comparison);

/// Names of the contests with a setting more than kelpie's.
std::vector<std::string> variants_of(const study::Comparison& comparison);

/// Which of the tried settings to use, with the gain, or "No gain: keep the defaults"; empty where
/// none was tried.
std::string settings_advice(const study::Comparison& comparison);

}  // namespace kelpie::report
