// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "lab/cross_validation.hpp"
#include "lab/published_protocol.hpp"
#include "study/result.hpp"

namespace kelpie::lab {

/// The real configuration 1 of the paper, and its source.
inline constexpr const char* kRealLogName = "dagon_config1.csv";

/// The experiments of a reproduction and their lengths.
struct ReproductionPlan {
  bool quick = false;                             ///< made by quick_plan()
  std::filesystem::path scenarios = "scenarios";  ///< folder with the scenario files
  std::string scenario = "paper";                 ///< the main stream's, without ".toml"
  std::vector<std::string> further{"aba", "concentrated"};
  std::filesystem::path data{};  ///< folder with the real log; empty: simulation only
  std::uint64_t first_seed = 1;
  std::size_t seeds = 5;          ///< of simulation and split, from first_seed on
  std::size_t further_seeds = 2;  ///< at most, on the further streams
  std::size_t paper_seeds = 1;    ///< at most, for the values of the paper, which take longest
  double scenario_share = 1.0;    ///< length of the phases of the main scenario, in (0, 1]
  double further_share = 1.0;     ///< length of the phases of further scenarios
  std::size_t real_rows = 0;      ///< first rows of the real log; 0: the whole log
  std::size_t validate_every = 200;
  std::size_t published_every = 5;  ///< steps between two scores of the published protocol
  int small_buffer = 300;           ///< of the pair that shows the effect of forgetting
  CrossValidationOptions grid;      ///< of the off-line baselines
  bool peers = true;                ///< the streams of the opponents, where present
  std::size_t threads = 0;          ///< 0: one per core; the results are the same

  /// Called now and then, from one thread at a time, with the finished share; false stops the work.
  std::function<bool(double)> keep_going = [](double) { return true; };

  /// Throws InputError with the field out of range.
  void validate() const;
};

/// The experiments of the paper at full length; about ten minutes on two cores.
ReproductionPlan full_plan();

/// The experiments shortened to less than a minute.
ReproductionPlan quick_plan();

/// A learner on a stream: a run per seed, each with every axis.
struct ContenderRuns {
  std::string key;
  std::string name;
  std::string settings;
  std::vector<std::vector<study::AxisResult>> seeds{};  ///< [seed][axis]
};

/// A stream under a split, with its learners.
struct StreamStudy {
  std::string key;  ///< "simulation", "real", or the name of a further scenario
  bool simulated = true;
  std::string source;  ///< file of the scenario or the log
  std::string split;   ///< label
  std::string split_kind;
  double rate_hz = 0.0;
  std::size_t training_rows = 0;
  std::size_t held_out_rows = 0;  ///< with the first seed
  std::string note;               ///< a remark on the scored rows, or ""
  std::vector<int> configurations;
  std::vector<std::string> axes;
  std::vector<ContenderRuns> contenders;
  std::vector<OfflineMatrix>
      offline;  ///< per axis, rows of the first seed; empty on further streams
};

/// The results of a reproduction.
struct Reproduction {
  ReproductionPlan plan;
  bool real_log = false;
  bool interrupted = false;  ///< incomplete results
  std::vector<StreamStudy> studies;
  std::vector<PublishedRun> published;  ///< kelpie and its FIFO; empty without the whole log
  std::vector<PeerRun> peers;           ///< empty where the streams are absent
};

/// Runs the plan. Ensures: but for times of updates the result depends on the plan without
/// `threads` and `keep_going` alone. Throws InputError on a missing or wrong scenario or log.
Reproduction reproduce(const ReproductionPlan& plan);

}  // namespace kelpie::lab
