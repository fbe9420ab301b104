// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "report/study_views.hpp"

namespace kelpie::report {

/// For a terminal: what was run, the learners over all vehicles, R² of each vehicle's axes.
std::string study_table(const StudyView& study);

/// One page: the same with figures, what has changed since an earlier study and from mission to
/// mission, the worst runs. Its size grows with the vehicles, up to kMostStudyRows, not with the
/// missions.
std::string study_html(const StudyView& study);

}  // namespace kelpie::report
