// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "chart/text_table.hpp"
#include "lab/diagnosis_study.hpp"

namespace kelpie::lab {

/// The results of a case over the seeds.
struct CaseSummary {
  std::size_t runs = 0;
  std::size_t right = 0;  ///< runs with the true causes named and no more
  std::size_t wrong = 0;  ///< runs with another name
  std::size_t held = 0;   ///< right runs with the true sizes inside the intervals
  double median_s = 0.0;  ///< from the change to the name, in right runs
  double longest_s = 0.0;
};
std::vector<CaseSummary> summaries(const DiagnosisStudy& study);  ///< In the order of the cases.

std::string diagnosis_table(const DiagnosisStudy& study);  ///< For a terminal.
std::string diagnosis_json(const DiagnosisStudy& study);   ///< docs/diagnosis.md

}  // namespace kelpie::lab
