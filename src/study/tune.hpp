// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "kelpie/model/settings.hpp"
#include "study/forward_chain.hpp"
#include "study/tune_journal.hpp"
#include "study/tune_problem.hpp"

namespace kelpie::study {

/// One evaluation in the order of the search, which threads and resuming don't change.
struct Evaluation {
  EvaluationKey key;
  ChainScore result;
};

/// The settings of one axis in the words of an EvaluationKey.
std::string settings_of(const ModelSettings& settings, std::size_t axis);

/// One axis' outcome.
struct TunedAxis {
  std::string name;
  double score = 0.0;    ///< of the chosen candidate on the rung below; NaN: none was judged
  std::size_t rung = 0;  ///< the last, unless the search was stopped before
  std::vector<double> references;  ///< score of each reference on all rows; NaN: not judged
  double least_squares = std::numeric_limits<double>::quiet_NaN();  ///< yardsticks on all rows
  double mean = least_squares;
};

/// What a search found, and all it tried.
struct TuneResult {
  ModelSettings tuned;
  std::vector<TunedAxis> axes;
  std::vector<std::pair<std::string, ModelSettings>> references;  ///< those of the problem
  std::vector<Evaluation> evaluations;
  std::vector<Rung> rungs;
  bool interrupted = false;
};

/// Random search with successive halving, every axis on its own: all candidates are judged on the
/// first rung of a ForwardChain, the better third goes on to the next, until the last; the base
/// settings always go on, so the result never scores below them there. Where scores are equal the
/// candidate drawn earlier wins. Shared settings can't differ between axes: the search is run for
/// each of their combinations, and the one with the best mean over the axes stays.
///
/// Finished evaluations are taken from and added to `journal`. Ensures: the result depends on
/// problem, candidates, seed and most_iterations alone, not on threads, nor on whether it came
/// from the journal. Stopped early, it has the best of the last rung that was finished (of those
/// judged so far, on the first). Throws what TuneOptions::validate() and ForwardChain throw.
TuneResult tune(const TuneProblem& problem, const TuneOptions& options, TuneJournal& journal);

}  // namespace kelpie::study
