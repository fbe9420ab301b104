// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
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

/// One evaluation in the order of the search, which threads and resuming don't change.
struct Evaluation {
  EvaluationKey key;
  ChainScore result;
};

/// A candidate's settings for an axis, judged on all logs.
struct TrialResult {
  std::string axis;
  std::size_t rung = 0;  ///< of all logs together
  std::string settings;  ///< in the words of an EvaluationKey
  double score = 0.0;    ///< mean over the logs; NaN where it was given up or went astray on one
  double iterations_per_row = 0.0;  ///< mean over the logs
  bool given_up = false;            ///< on one log or more
};

/// The settings of one axis alone, and in the words of an EvaluationKey.
ModelSettings one_axis(const ModelSettings& settings, std::size_t axis);
std::string settings_of(const ModelSettings& settings, std::size_t axis);

/// Scores on all rows of a log, or their means over the logs. NaN: not judged on each.
struct TuneScores {
  double tuned = kUnknown;
  double base = kUnknown;           ///< the settings that the search started from
  std::vector<double> references;   ///< of each reference
  double least_squares = kUnknown;  ///< baselines
  double mean = kUnknown;
};

/// One axis' outcome.
struct TunedAxis {
  std::string name;
  double score = 0.0;    ///< of the chosen candidate on the rung below; NaN: none was judged
  std::size_t rung = 0;  ///< the last, unless the search was stopped before
  TuneScores all{};      ///< means over the logs
  std::vector<TuneScores> logs{};
};

/// A log of a search.
struct TunedLog {
  std::string name;
  std::size_t rows = 0;  ///< training rows
  std::vector<Rung> rungs{};
};

/// What a search found, and all it tried.
struct TuneResult {
  ModelSettings tuned;
  std::vector<TunedAxis> axes;
  std::vector<TunedLog> logs;
  std::vector<std::pair<std::string, ModelSettings>> references;  ///< those of the problem
  std::vector<std::size_t> rungs;  ///< rows of each, in all logs together
  std::vector<TrialResult> trials;
  std::vector<Evaluation> evaluations;
  bool interrupted = false;
};

/// Random search with successive halving, every axis on its own: all candidates are judged on the
/// first rung of a ForwardChain of each log, the better third goes on to the next, until the last;
/// the base settings always go on, so the result never scores below them there. A candidate is
/// ranked by the mean of its scores over the logs, each of which counts alike however long it is;
/// one that was given up on a log, or went astray there, comes last. Where scores are equal the
/// candidate drawn earlier wins. Shared settings can't differ between axes: the search is run for
/// each of their combinations, and the one with the best mean over the axes stays.
///
/// Finished evaluations are taken from and added to `journal`. Ensures: the result depends on
/// problem, candidates, seed and most_iterations alone, not on where evaluations were made, nor on
/// whether they came from the journal. Stopped early, it has the best of the last rung that was
/// finished (of those judged so far, on the first). Requires that the executor leads. Throws what
/// TuneProblem::validate(), TuneOptions::validate() and ForwardChain throw.
TuneResult tune(const TuneProblem& problem, const TuneOptions& options, TuneJournal& journal,
                jobs::Executor& executor);

/// What the other processes of the executor do meanwhile, with the same problem and options.
void help_to_tune(const TuneProblem& problem, const TuneOptions& options, jobs::Executor& executor);

}  // namespace kelpie::study
