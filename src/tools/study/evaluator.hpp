// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "jobs/executor.hpp"
#include "study/tune_journal.hpp"
#include "study/tune_problem.hpp"

namespace kelpie::study {

/// One requested evaluation.
struct EvaluationTask {
  EvaluationKey key;
  std::size_t axis = 0;
  ModelSettings settings{};  ///< of the axis alone; empty for a baseline
};

/// EvaluationKey::settings of the baselines (baselines.hpp).
inline constexpr std::string_view kLeastSquares = "least squares";
inline constexpr std::string_view kMean = "mean";

/// Makes evaluations by an executor, and enters the results in the journal.
class Evaluator {
 public:
  /// `rows_planned`: rows that all tasks together will show to learners, for the progress.
  Evaluator(const TuneProblem& problem, const ChainSet& chains, const TuneOptions& options,
            jobs::Executor& executor, double rows_planned);

  /// Makes the evaluations missing in the journal. Throws what a task throws.
  void run(const std::vector<EvaluationTask>& tasks, TuneJournal& journal);

  /// Whether the user stopped the search; tasks may then be missing in the journal.
  bool stopped() const { return stopped_; }

 private:
  std::string work(const EvaluationTask& task, const jobs::Advance& advance) const;
  double rows(const EvaluationTask& task) const;

  const TuneProblem& problem_;
  const ChainSet& chains_;
  const TuneOptions& options_;
  jobs::Executor& executor_;
  double rows_planned_;
  double rows_done_ = 0.0;
  bool stopped_ = false;
};

}  // namespace kelpie::study
