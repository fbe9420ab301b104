// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kelpie/core/scaling.hpp"
#include "kelpie/motion/term_set.hpp"
#include "kelpie/online/online_svr.hpp"
#include "kelpie/online/past_model.hpp"

namespace kelpie {

/// A past model of one axis as it is kept beyond a run, in the units of the log: its samples, from
/// which it can be learned again with any settings and any scale.
struct StoredPastModel {
  PastModelInfo info;           ///< the usual error in the target's unit
  std::vector<double> inputs;   ///< row-major, a row per sample
  std::vector<double> targets;  ///< a value per sample
  std::vector<double> times_s;
};

/// A past model in the units of the log. Allocates.
StoredPastModel in_log_units(const PastModel& past, const AxisScaling& scaling);

/// The samples of a remembered model as a learner takes them, the latest ones where it has less
/// room; its function is still to be learned. `like` is the learner. Requires samples, and as many
/// inputs as the scaling has. Allocates.
PastModel in_learner_units(const StoredPastModel& model, const AxisScaling& scaling,
                           const TermSet& terms, const OnlineSvr& like);

}  // namespace kelpie
