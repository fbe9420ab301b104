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
#include "study/search_space.hpp"
#include "study/tune_journal.hpp"

namespace kelpie::study {

/// A search for the settings that learn one configuration's stream best.
struct TuneProblem {
  const log::Dataset& data;
  std::vector<std::size_t> rows;  ///< training rows of one configuration, in time order
  ModelSettings base;             ///< where the search starts: the first candidate
  SearchSpace space;
  /// Judged on all rows for comparison, and never chosen: name and settings.
  std::vector<std::pair<std::string, ModelSettings>> references;

  /// The base under every combination of the shared settings that are searched.
  std::vector<ModelSettings> combinations() const;

  /// The most samples that a combination takes its scaling from.
  std::size_t warmup() const;
};

/// How a search goes.
struct TuneOptions {
  std::size_t candidates = 60;  ///< per axis, the base settings among them
  std::uint64_t seed = 1;
  std::size_t threads = 0;           ///< 0: one per core
  double most_iterations = 3'000.0;  ///< of the solver per row: above, a candidate is given up

  /// Called now and then, from one thread at a time, with the share done; false stops the search.
  std::function<bool(double)> keep_going = [](double) { return true; };

  /// Makes a learner from the settings of one axis (`axes` has that one alone).
  std::function<std::unique_ptr<OnlineRegressor>(const ModelSettings&)> make_learner;

  /// The proposed learner, with its scaling from the first samples it sees.
  static TuneOptions of_online_svr(const std::vector<std::string>& inputs, std::size_t targets);

  void validate() const;  ///< Throws InputError naming the field.
};

/// What of a search goes into the header of its journal.
TuneJournal::Header journal_header(const TuneProblem& problem, const TuneOptions& options,
                                   const std::string& split);

}  // namespace kelpie::study
