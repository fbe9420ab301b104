// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <mutex>
#include <vector>

#include "study/forward_chain.hpp"
#include "study/tune_journal.hpp"
#include "study/tune_problem.hpp"

namespace kelpie::study {

/// One evaluation to be made.
struct Job {
  std::size_t axis = 0;
  ModelSettings settings;  ///< of that axis alone
  EvaluationKey key;
};

/// Makes evaluations on all threads and enters them in the journal.
class Evaluator {
 public:
  /// `rows_planned`: rows that all jobs together will show to learners, for the progress.
  Evaluator(const ForwardChain& chain, const TuneOptions& options, TuneJournal& journal,
            std::size_t rows_planned)
      : chain_(chain), options_(options), journal_(journal), rows_planned_(rows_planned) {}

  /// Makes those that the journal doesn't have. What a job throws is thrown here, after all threads
  /// have come to an end.
  void run(const std::vector<Job>& jobs);

  /// Whether the user has had enough: then some jobs may be missing from the journal.
  bool stopped() const { return stopped_; }

 private:
  void make(const Job& job);
  void advance(std::size_t rows);

  const ForwardChain& chain_;
  const TuneOptions& options_;
  TuneJournal& journal_;  // like rows_done_ under mutex_ while threads run
  std::mutex mutex_;
  std::size_t rows_planned_;
  std::size_t rows_done_ = 0;
  std::atomic<bool> stopped_{false};
};

}  // namespace kelpie::study
