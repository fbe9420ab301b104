// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "kelpie/model/settings.hpp"
#include "kelpie/online/regressor.hpp"
#include "log/dataset.hpp"
#include "study/forward_chain.hpp"
#include "study/search_space.hpp"
#include "study/tune_journal.hpp"

namespace kelpie::study {

/// One log of a search.
struct TuneLog {
  log::Dataset data;
  std::vector<std::size_t> rows;  ///< training rows of one configuration, in time order
  std::string split;              ///< what was held out, in words
};

/// A search for the settings that learn one or more logs best, each of them a stream of its own.
struct TuneProblem {
  std::vector<TuneLog> logs;  ///< one or more
  ModelSettings base;         ///< where the search starts: the first candidate
  SearchSpace space;
  /// Judged on all rows for comparison, and never chosen: name and settings.
  std::vector<std::pair<std::string, ModelSettings>> references;

  /// Throws InputError naming a log that stands twice, whose targets aren't the first one's, or
  /// which a combination can't learn: a column that its settings name is missing, or the scaling
  /// can't be found on line.
  void validate() const;

  const std::vector<std::string>& targets() const { return logs.front().data.target_names; }

  /// The base under every combination of the shared settings that are searched.
  std::vector<ModelSettings> combinations() const;

  /// The most samples that a combination takes its scaling from.
  std::size_t warmup() const;
};

/// How a search goes.
struct TuneOptions {
  std::size_t candidates = 60;  ///< per axis, the base settings among them
  std::uint64_t seed = 1;
  double most_iterations = 3'000.0;  ///< of the solver per row: above, a candidate is given up

  /// Called now and then, from one thread at a time, with the share done; false stops the search.
  std::function<bool(double)> keep_going = [](double) { return true; };

  /// Makes a learner of a log's rows from the settings of one axis (`axes` has that one alone).
  /// Called by any thread.
  std::function<std::unique_ptr<OnlineRegressor>(const log::Dataset&, const ModelSettings&)>
      make_learner = online_learner;

  /// The proposed learner, with its scaling from the first samples it sees.
  static std::unique_ptr<OnlineRegressor> online_learner(const log::Dataset& data,
                                                         const ModelSettings& settings);

  void validate() const;  ///< Throws InputError naming the field.
};

/// What of a search goes into the header of its journal, and what all processes of it agree in.
TuneJournal::Header journal_header(const TuneProblem& problem, const TuneOptions& options);

/// The forward chains of a search's logs, whose rungs are climbed together. A log too short for as
/// many rungs as another stays on its first until the others have come as far: all end on their
/// last, on all rows.
class ChainSet {
 public:
  /// Requires that `problem` outlives it. Throws what ForwardChain throws.
  explicit ChainSet(const TuneProblem& problem);

  std::size_t logs() const { return chains_.size(); }
  std::size_t rungs() const { return rungs_; }  ///< those of the log that has the most
  const ForwardChain& operator[](std::size_t log) const { return chains_[log]; }

  /// Which of a log's own rungs belongs to one of all together.
  std::size_t rung_of(std::size_t log, std::size_t rung) const;
  /// Rows of a rung, in all logs together.
  std::size_t rows(std::size_t rung) const;

 private:
  std::vector<ForwardChain> chains_;
  std::size_t rungs_ = 0;
};

}  // namespace kelpie::study
