// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "kelpie/svr/regressor.hpp"
#include "log/dataset.hpp"

namespace kelpie::study {

/// A fresh learner of one axis, in raw units.
using LearnerFactory = std::function<std::unique_ptr<OnlineRegressor>()>;

/// A piece of the stream for a fresh learner, as positions in the list of rows.
struct Window {
  std::size_t begin = 0;
  std::size_t judged_from = 0;  ///< earlier rows are learned without a score
  std::size_t end = 0;
};

/// One budget: the windows on which a learner is scored.
struct Rung {
  std::vector<Window> windows;
  std::size_t rows = 0;  ///< in all windows together
};

/// Score of one learner on one rung.
struct ChainScore {
  double score = std::numeric_limits<double>::quiet_NaN();  ///< mean of `stretches`; see score()
  std::vector<double> stretches;  ///< 1 − (mean squared error) / (common variance), each stretch
  double iterations_per_row = 0.0;  ///< of the solver
  bool given_up = false;            ///< over the limit of iterations; score is NaN
  bool stopped = false;             ///< by the watcher; score is NaN
};

/// Cross-validation without a look into the future. The scored rows of a window are cut into
/// stretches; the learner is scored on a stretch, learns the stretch, and goes on to the next: one
/// pass for all stretches.
///
/// The mean squared error of every stretch is divided by one number, the variance of the target
/// over all rows of the chain. A division by the stretch's own variance would weight a stretch of
/// hardly any acceleration a hundredfold. With one divisor all rows have equal weight, and scores
/// of different windows and rungs are on one scale. The divisor doesn't change the ranking.
class ForwardChain {
 public:
  /// `rows` in time order. A learner needs `warmup` samples for its first model, so scoring begins
  /// after 1.25 times as many samples (or after one of six equal parts, if longer). Throws
  /// InputError with too few rows.
  ForwardChain(const log::Dataset& data, std::vector<std::size_t> rows, std::size_t warmup);

  /// From the cheapest: three windows (early, middle, late) of 1/18 of the rows each, three of 1/6,
  /// then one window of all rows. Rungs with too few rows are left out.
  const std::vector<Rung>& rungs() const { return rungs_; }

  const std::vector<std::size_t>& rows() const { return rows_; }

  /// Called with the number of rows shown since the last call; false stops the scoring.
  using Watcher = std::function<bool(std::size_t)>;

  /// Scores fresh learners on a rung, one per window. Gives up after more than `most_iterations` of
  /// the solver per row of the rung (a count, not a time: reproducible). The score is not finite
  /// where a prediction isn't. Safe from many threads.
  ChainScore score(std::size_t rung, std::size_t axis, const LearnerFactory& make,
                   double most_iterations, const Watcher& watch) const;

 private:
  class Pass;

  const log::Dataset& data_;
  std::vector<std::size_t> rows_;
  std::vector<Rung> rungs_;
  std::vector<double> variance_;  ///< of each target
};

}  // namespace kelpie::study
