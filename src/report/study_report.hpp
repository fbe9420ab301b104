// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "report/study_views.hpp"

namespace kelpie::report {

/// For a terminal: the runs, the learners over every vehicle, R² by vehicle and axis.
std::string study_table(const StudyView& study);

/// One page: as study_table() with figures, changes since an earlier study, trends over missions,
/// and the worst runs. The size grows with the vehicles, up to kMostStudyRows, not with the
/// missions.
std::string study_html(const StudyView& study);

}  // namespace kelpie::report
