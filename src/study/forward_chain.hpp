// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "kelpie/online/regressor.hpp"
#include "log/dataset.hpp"

namespace kelpie::study {

/// A fresh learner of one axis, in raw units.
using LearnerFactory = std::function<std::unique_ptr<OnlineRegressor>()>;

/// A piece of the stream that a fresh learner goes through, as positions in the list of rows.
struct Window {
  std::size_t begin = 0;
  std::size_t judged_from = 0;  ///< the rows before are only learned
  std::size_t end = 0;
};

/// One budget: the windows a learner is judged on.
struct Rung {
  std::vector<Window> windows;
  std::size_t rows = 0;  ///< in all windows together
};

/// How well one learner did on one rung.
struct ChainScore {
  double score = std::numeric_limits<double>::quiet_NaN();  ///< mean of `stretches`; see score()
  std::vector<double> stretches;  ///< 1 − (mean squared error) / (common variance), each stretch
  double iterations_per_row = 0.0;  ///< of the solver
  bool given_up = false;            ///< over the limit of iterations; score is NaN
  bool stopped = false;             ///< by the watcher; score is NaN
};

/// Cross-validation that never shows a learner the future: within a window the judged rows are cut
/// into stretches; the learner is judged on a stretch, then learns it, then is judged on the next.
/// One pass serves all stretches.
///
/// Every stretch's mean squared error is divided by the same number, the variance of the target
/// over all rows of the chain. Divided by its own variance, a stretch in which the vehicle hardly
/// accelerates would count a hundredfold; so a row counts alike wherever it lies, and scores of
/// different windows and rungs are on one scale. It is one constant for all candidates: it ranks
/// nobody.
class ForwardChain {
 public:
  /// `rows` of one axis' data in time order. Learners are held to need `warmup` samples before
  /// they have a model, so judging begins a quarter later (or after one of six equal parts, if
  /// that is longer). Throws InputError when the rows are too few for that.
  ForwardChain(const log::Dataset& data, std::vector<std::size_t> rows, std::size_t warmup);

  /// From the cheapest: three windows (early, middle, late) of 1/18 of the rows each, three of 1/6,
  /// then all rows in one. Rungs for which the rows are too few are left out.
  const std::vector<Rung>& rungs() const { return rungs_; }

  const std::vector<std::size_t>& rows() const { return rows_; }

  /// Called with the number of rows shown since its last call; false stops the scoring.
  using Watcher = std::function<bool(std::size_t)>;

  /// Scores a learner on a rung, a fresh one in each window. Gives up once the solver has made
  /// more than `most_iterations` per row of the rung (a count, not a time: reproducible). The score
  /// is not finite where a prediction wasn't. Safe from many threads.
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
