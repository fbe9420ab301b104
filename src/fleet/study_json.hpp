// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "file/atomic_file.hpp"
#include "fleet/earlier_study.hpp"
#include "fleet/results.hpp"
#include "fleet/summary.hpp"

namespace kelpie::fleet {

inline constexpr const char* kStudyFormat = "kelpie-study";
inline constexpr int kStudyVersion = 1;
inline constexpr const char* kRunsKey = "runs";  ///< of what came of each combination

/// Everything as JSON (docs/study.md), run by run: a file of ten thousand runs is never in memory.
/// `change`: beside an earlier study, or null. Requires that all of them outlive what is returned,
/// which throws Failure where an outcome can't be read.
file::Content study_json(const Results& results, const StudySummary& summary,
                         const StudyChange* change);

}  // namespace kelpie::fleet
