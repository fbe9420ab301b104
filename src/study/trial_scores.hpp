// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "study/tune.hpp"
#include "study/tune_journal.hpp"
#include "study/tune_problem.hpp"

namespace kelpie::study {

/// What the evaluations in a journal say of settings on all logs together.
class TrialScores {
 public:
  /// Requires that all of them outlive it.
  TrialScores(const TuneProblem& problem, const ChainSet& chains, const TuneJournal& journal)
      : problem_(problem), chains_(chains), journal_(journal) {}

  /// Of an evaluation on the log's rung that belongs to `rung`.
  EvaluationKey key(std::size_t log, std::size_t axis, std::size_t rung,
                    const std::string& settings) const;

  /// Nothing where a log's evaluation is missing.
  std::optional<TrialResult> trial(std::size_t axis, std::size_t rung,
                                   const std::string& settings) const;

  /// The scores of chosen settings on all rows, beside those of whom they are compared with. Of
  /// TunedAxis, `score` and `rung` are the caller's to fill in.
  TunedAxis outcome(std::size_t axis, const std::string& chosen) const;

 private:
  void fill(TunedAxis& outcome, std::size_t axis, const std::string& settings,
            const std::function<double&(TuneScores&)>& place) const;

  const TuneProblem& problem_;
  const ChainSet& chains_;
  const TuneJournal& journal_;
};

}  // namespace kelpie::study
