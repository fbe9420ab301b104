// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kelpie/svr/past_model_info.hpp"

namespace kelpie {

/// A past model of one axis, stored beyond a run in the units of the log: sums over samples.
struct StoredPastModel {
  PastModelInfo info;            ///< the usual error in the target's unit
  double rows_per_sample = 1.0;  ///< rows of an independent sample
  /// Sums over n independent samples with weights w, of the target y less an origin o and features
  /// φ, the constant 1 and the terms in their order: o, n, Σ w, Σ w y², each Σ w y φ_i, and Σ w φ_i
  /// φ_j for each i and each j up to i.
  std::vector<double> sums{};
};

}  // namespace kelpie
