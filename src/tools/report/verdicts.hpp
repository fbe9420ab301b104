// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "report/study_report.hpp"
#include "study/comparison.hpp"
#include "study/identification.hpp"
#include "study/open_loop_study.hpp"
#include "study/tune.hpp"

namespace kelpie::report {

// Results in some ten lines for a terminal: what was asked of which rows, the answer, the figures
// that show the answer, warnings. No line is wider than 100 columns, except names. verdict.hpp has
// that of `kelpie learn`.

/// Which setting to use, R² of the contenders by axis, and what an update takes. Requires kelpie as
/// the first contest.
std::string comparison_verdict(const study::Comparison& comparison);

/// Whether the tuned settings gain, scores beside those of the start, and the work of the solver.
std::string tune_verdict(const study::TuneResult& result);

/// Errors of the velocities by horizon, and whether the model beats a held velocity.
std::string rollout_verdict(const study::OpenLoopResult& result);

/// R² of the identified vehicle, the worst axis first; how many parameters the log tells; remarks.
std::string identification_verdict(const study::Identification& found);

/// What became of which vehicle, then how the learners did.
std::string study_verdict(const StudyView& study);

}  // namespace kelpie::report
