// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "jobs/executor.hpp"
#include "kelpie/model/settings.hpp"
#include "study/forward_chain.hpp"
#include "study/result.hpp"
#include "study/tune_journal.hpp"
#include "study/tune_problem.hpp"

namespace kelpie::study {

/// One evaluation. Their order is the order of the search, whatever the threads and resumptions.
struct Evaluation {
  EvaluationKey key;
  ChainScore result;
};

/// A candidate's settings for an axis, scored on every log.
struct TrialResult {
  std::string axis;
  std::size_t rung = 0;  ///< of the common rungs of the logs
  std::string settings;  ///< text of EvaluationKey::settings
  double score = 0.0;    ///< mean over the logs; NaN after giving up or diverging on a log
  double iterations_per_row = 0.0;  ///< mean over the logs
  bool given_up = false;            ///< on one log or more
};

/// The settings of one axis, as settings and as text of EvaluationKey::settings.
ModelSettings one_axis(const ModelSettings& settings, std::size_t axis);
std::string settings_of(const ModelSettings& settings, std::size_t axis);

/// Scores on the full rows of a log, or their means over the logs. NaN: not scored on every log.
struct TuneScores {
  double tuned = kUnknown;
  double base = kUnknown;           ///< the settings at the start of the search
  std::vector<double> references;   ///< of each reference
  double least_squares = kUnknown;  ///< baseline
  double mean = kUnknown;

  double gain() const { return tuned - base; }  ///< 0 where the search kept the base.
};

/// Outcome of one axis.
struct TunedAxis {
  std::string name;
  double score = 0.0;    ///< of the chosen candidate on `rung`; NaN: no candidate was scored
  std::size_t rung = 0;  ///< the last rung, unless the search was stopped
  TuneScores all{};      ///< means over the logs
  std::vector<TuneScores> logs{};
};

/// A log of a search.
struct TunedLog {
  std::string name;
  std::size_t rows = 0;  ///< training rows
  std::vector<Rung> rungs{};
};

/// Result of a search, with its trials.
struct TuneResult {
  ModelSettings tuned;
  std::vector<TunedAxis> axes;
  std::vector<TunedLog> logs;
  std::vector<std::pair<std::string, ModelSettings>> references;  ///< of the problem
  std::vector<std::size_t> rungs;  ///< rows of each rung, summed over the logs
  std::vector<TrialResult> trials;
  std::vector<Evaluation> evaluations;
  bool interrupted = false;
};

/// Random search with successive halving, for every axis on its own. The first rung of a
/// ForwardChain of each log scores every candidate; the better third advances to the next rung,
/// until the last. The base settings always advance, so the result never scores below the base;
/// they advance alone, and win, where no candidate scores higher by 0.005 or more. Candidates are
/// ranked by their mean score over the logs, with equal weights; candidates given up or diverging
/// on a log come last, and earlier draws win ties. The search is run for each combination of the
/// shared settings, which can't differ between axes; the combination with the best mean over the
/// axes wins.
///
/// `journal` provides and stores evaluations. Ensures: the result depends on problem, candidates,
/// seed and most_iterations only, not on the processes, nor on the journal's content. A stopped
/// search returns the best candidates of the last finished rung (on the first rung: so far).
/// Throws what TuneProblem::validate(), TuneOptions::validate()
/// and ForwardChain throw.
TuneResult tune(const TuneProblem& problem, const TuneOptions& options, TuneJournal& journal,
                jobs::Executor& executor);

}  // namespace kelpie::study
