# SPDX-License-Identifier: Apache-2.0
# Public headers of version 1 that moved to another room: the old name includes the new one and tells so,
# for one version (docs/reference/limits.md, "What stays").
set(KELPIE_MOVED_HEADERS "${PROJECT_BINARY_DIR}/moved")
foreach(pair IN ITEMS
    "model/alignment alignment/alignment" "model/live_alignment alignment/live_alignment"
    "motion/diagnosis vehicle/diagnosis" "motion/planar_fit identify/planar_fit"
    "learner/decision svr/decision" "learner/online_svr svr/online_svr"
    "learner/past_model_info svr/past_model_info" "learner/regressor svr/regressor"
    "learner/settings svr/settings")
  separate_arguments(pair)
  list(GET pair 0 old)
  list(GET pair 1 new)
  file(CONFIGURE OUTPUT "${KELPIE_MOVED_HEADERS}/kelpie/${old}.hpp" CONTENT
"#pragma once
#pragma message(\"kelpie/${old}.hpp is kelpie/${new}.hpp since version 2, which keeps the old name\")
#include \"kelpie/${new}.hpp\"
")
endforeach()
