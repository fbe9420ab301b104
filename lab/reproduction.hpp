// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "lab/contenders.hpp"
#include "lab/cross_validation.hpp"
#include "study/result.hpp"
#include "study/summary.hpp"

namespace kelpie::lab {

/// The real configuration 1 of the paper, and its source.
inline constexpr const char* kRealLogName = "dagon_config1.csv";

/// The experiments of a reproduction and their lengths.
struct ReproductionPlan {
  bool quick = false;                                ///< made by quick_plan()
  std::filesystem::path scenarios = "scenarios";     ///< folder with the scenario files
  std::string scenario = "paper";                    ///< the main stream's, without ".toml"
  std::vector<std::string> further{"concentrated"};  ///< a long stretch at low speed
  std::filesystem::path data{};  ///< folder with the real log; empty: simulation only
  std::uint64_t first_seed = 1;
  std::size_t seeds = 5;          ///< of simulation and split, from first_seed on
  std::size_t further_seeds = 1;  ///< at most, on the further streams
  double scenario_share = 1.0;    ///< length of the phases of the main scenario, in (0, 1]
  double further_share = 1.0;     ///< length of the phases of further scenarios
  std::size_t real_rows = 0;      ///< first rows of the real log; 0: the whole log
  std::size_t validate_every = 200;
  std::size_t folds = 3;               ///< of the search for settings of on-line learners
  CrossValidationOptions grid;         ///< of the off-line baselines
  std::vector<std::string> entries{};  ///< learners of the reader's: FILE.py:CLASS, MODULE:CLASS
  std::string command = "kelpie-lab reproduce";  ///< for the page
  std::string version{};                         ///< of kelpie, for the page
  std::size_t threads = 0;                       ///< 0: one per core; the results are the same

  /// Called now and then, from one thread at a time, with the finished share; false stops the work.
  std::function<bool(double)> keep_going = [](double) { return true; };

  /// Throws InputError with the field out of range.
  void validate() const;
};

ReproductionPlan full_plan();   ///< The experiments of the paper at full length.
ReproductionPlan quick_plan();  ///< The experiments shortened to less than a minute.

/// A learner's run over a stream.
struct SeedRun {
  std::vector<study::AxisResult> axes;  ///< validation, stages and status alone
  study::Quantiles update_us;           ///< of all axes together, with other jobs in parallel
};

/// A learner on a stream, a run per seed.
struct RowRuns {
  std::string key;
  RowKind kind = RowKind::entry;
  std::string name;
  std::string settings;
  std::vector<SeedRun> seeds{};
};

/// A stream under a split, with its learners.
struct StreamStudy {
  std::string key;  ///< "simulation", "real", or the name of a further scenario
  bool simulated = true;
  std::string source;  ///< file of the scenario or the log
  study::SplitKind split_kind = study::SplitKind::random;
  std::string split;  ///< label
  double rate_hz = 0.0;
  std::size_t training_rows = 0;
  std::size_t held_out_rows = 0;  ///< with the first seed
  std::string note;               ///< a remark on the scored rows, or ""
  std::vector<int> configurations;
  std::vector<std::string> axes;
  std::vector<RowRuns> rows{};
  /// Settings found by family (searched_families()) and axis; empty on further streams, which take
  /// those of the main stream.
  std::vector<std::vector<FoundSettings>> found{};
  /// Without terms and with terms, per axis, rows of the first seed; empty on further streams.
  std::vector<OfflineMatrix> offline{};
  std::vector<OfflineMatrix> offline_terms{};
};

/// The results of a reproduction.
struct Reproduction {
  ReproductionPlan plan;
  bool real_log = false;
  bool interrupted = false;  ///< incomplete results
  std::vector<StreamStudy> studies;
};

/// Runs the plan. Ensures: but for times of updates the result depends on the plan without
/// `threads` and `keep_going` alone. Throws InputError on a missing or wrong scenario, log or
/// entry, Failure where an entry fails.
Reproduction reproduce(const ReproductionPlan& plan);

}  // namespace kelpie::lab
