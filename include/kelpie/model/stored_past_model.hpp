// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kelpie/svr/past_model_info.hpp"

namespace kelpie {

class OnlineSvr;
class TermSet;
struct AxisScaling;
struct PastModel;

/// A past model of one axis, stored beyond a run in the units of the log: of `learner = posterior`
/// sums over samples, of other learners the samples, from which the model can be learned again with
/// any settings and any scale.
struct StoredPastModel {
  PastModelInfo info;           ///< the usual error in the target's unit
  std::vector<double> inputs;   ///< row-major, a row per sample
  std::vector<double> targets;  ///< a value per sample
  std::vector<double> times_s;
  double rows_per_sample = 1.0;  ///< rows of an independent sample
  /// Sums over n independent samples with weights w, of the target y less an origin o and features
  /// φ, the constant 1 and the terms in their order: o, n, Σ w, Σ w y², each Σ w y φ_i, and Σ w φ_i
  /// φ_j for each i and each j up to i.
  std::vector<double> sums{};
};

/// A past model in the units of the log. Allocates.
StoredPastModel in_log_units(const PastModel& past, const AxisScaling& scaling);

/// The samples of a stored model in the units of the learner `like`, the latest samples where room
/// is short; without a function, which the learner learns. Requires samples, and the number of
/// inputs of the scaling. Allocates.
PastModel in_learner_units(const StoredPastModel& model, const AxisScaling& scaling,
                           const TermSet& terms, const OnlineSvr& like);

}  // namespace kelpie
