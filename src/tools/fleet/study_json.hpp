// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "file/atomic_file.hpp"
#include "fleet/earlier_study.hpp"
#include "fleet/results.hpp"
#include "fleet/summary.hpp"

namespace kelpie::fleet {

inline constexpr const char* kStudyFormat = "kelpie-study";
inline constexpr int kStudyVersion = 1;
inline constexpr const char* kRunsKey = "runs";  ///< key of the outcomes

/// Content of study.json (howto/studies.md), produced run by run: a file of 10,000 runs is never
/// in memory as a whole. `change` is null without an earlier study. Requires that the arguments
/// outlive the returned content. Writing the content throws Failure if an outcome cannot be read.
file::Content study_json(const Results& results, const StudySummary& summary,
                         const StudyChange* change);

}  // namespace kelpie::fleet
