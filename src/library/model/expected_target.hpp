// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kelpie/motion/term_set.hpp"
#include "learner/triangular_fit.hpp"
#include "model/tuning.hpp"
#include "svr/robust_scale.hpp"

namespace kelpie {

/// The target that physics leads to expect: a second opinion on targets far beyond the scale of an
/// axis. A calm vehicle that manoeuvres for a second has such targets, and so has a sensor that is
/// out of order; a manoeuvre follows from the inputs like the manoeuvres before, garbage does not.
///
/// Least squares on all physics terms, in raw units, over all samples with inputs within the scale.
/// An error of e > 3 usual errors has the weight 3/e (Huber): manoeuvres count, and garbage counts
/// little. Allocates in the constructor only.
class ExpectedTarget {
 public:
  explicit ExpectedTarget(const TermSet& terms);

  /// Learns a sample of finite values. `doubtful`: the sample is of a stretch of implausible
  /// samples. expects() takes such a stretch into account from its end on, since garbage may
  /// explain further garbage. Cost O(m²) for m terms.
  void learn(std::span<const double> x, double y, bool doubtful);

  /// Whether physics explains more than half of the distance of the target y from `mean`, the usual
  /// target. Not before there are ten samples per term. Cost O(m).
  bool expects(std::span<const double> x, double y, double mean) const;

  void clear();  ///< Forgets the samples.

  void visit(Archive& archive);  ///< core/archive.hpp

  /// Memory in bytes, beside the object itself.
  static std::size_t bytes(std::size_t terms);

 private:
  void compute_features(std::span<const double> x) const;

  TermSet terms_;
  TriangularFit fit_;            ///< of φ, 1
  std::vector<double> weights_;  ///< θ before the present stretch of implausible samples
  RobustScale usual_error_{kModelTuning.expected.least_errors, kModelTuning.expected.error_every};
  mutable std::vector<double> features_;  ///< scratch: φ, 1
};

}  // namespace kelpie
