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
#include "kelpie/svr/regressor.hpp"
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

/// A search for the best settings for one or more logs, each a stream of its own.
struct TuneProblem {
  std::vector<TuneLog> logs;  ///< one or more
  ModelSettings base;         ///< the first candidate
  SearchSpace space;
  /// Scored on the full rows for comparison, never chosen: name and settings.
  std::vector<std::pair<std::string, ModelSettings>> references;

  /// Throws InputError naming a log that is given twice, that has other targets than the first log,
  /// or that a combination can't learn: a column of its settings is missing, or no scaling can be
  /// found on line.
  void validate() const;

  const std::vector<std::string>& targets() const { return logs.front().data.target_names; }

  /// The base with every combination of the searched shared settings.
  std::vector<ModelSettings> combinations() const;

  /// The largest `warmup` of the combinations.
  std::size_t warmup() const;
};

/// Options of a search.
struct TuneOptions {
  std::size_t candidates = 60;  ///< per axis, base settings included
  std::uint64_t seed = 1;
  double most_iterations = 3'000.0;  ///< of the solver per row; limit for giving a candidate up

  /// Called now and then, by one thread at a time, with the finished share; false stops the search.
  std::function<bool(double)> keep_going = [](double) { return true; };

  /// Makes a learner for a log from the settings of one axis. Called by any thread.
  std::function<std::unique_ptr<OnlineRegressor>(const log::Dataset&, const ModelSettings&)>
      make_learner = online_learner;

  /// The proposed learner, scaled by its first samples.
  static std::unique_ptr<OnlineRegressor> online_learner(const log::Dataset& data,
                                                         const ModelSettings& settings);

  void validate() const;  ///< Throws InputError naming the field.
};

/// The header of a search's journal; equal in every process of the search.
TuneJournal::Header journal_header(const TuneProblem& problem, const TuneOptions& options);

/// The forward chains of a search's logs with common rungs. A log with fewer rungs repeats its
/// first rung, so that every log ends on its last rung, the full rows.
class ChainSet {
 public:
  /// Requires that `problem` outlives the chains. Throws what ForwardChain throws.
  explicit ChainSet(const TuneProblem& problem);

  std::size_t logs() const { return chains_.size(); }
  std::size_t rungs() const { return rungs_; }  ///< the largest number of rungs of a log
  const ForwardChain& operator[](std::size_t log) const { return chains_[log]; }

  /// The log's own rung for a common rung.
  std::size_t rung_of(std::size_t log, std::size_t rung) const;
  /// Rows of a common rung, summed over the logs.
  std::size_t rows(std::size_t rung) const;

 private:
  std::vector<ForwardChain> chains_;
  std::size_t rungs_ = 0;
};

}  // namespace kelpie::study
