// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "lab/cross_validation.hpp"
#include "lab/offline_matrix.hpp"
#include "lab/peer_protocol.hpp"
#include "lab/published_protocol.hpp"
#include "study/result.hpp"

namespace kelpie::lab {

/// The paper's real configuration 1, and where it can be had.
inline constexpr const char* kRealLogName = "dagon_config1.csv";

/// What of the paper is measured, and at what expense.
struct ReproductionPlan {
  bool quick = false;                             ///< as quick_plan() made it
  std::filesystem::path scenarios = "scenarios";  ///< folder with the scenario files
  std::string scenario = "paper";                 ///< the main stream's, without ".toml"
  std::vector<std::string> further{"aba", "concentrated"};
  std::filesystem::path data{};  ///< folder with the real log; empty: simulation only
  std::uint64_t first_seed = 1;
  std::size_t seeds = 5;          ///< of simulation and split, first_seed and those after it
  std::size_t further_seeds = 2;  ///< at most, on the further streams
  std::size_t paper_seeds = 1;    ///< at most, for the paper's values as written: they take longest
  double scenario_share = 1.0;    ///< the main scenario's phases are so much shorter, in (0, 1]
  double further_share = 1.0;     ///< those of the further ones
  std::size_t real_rows = 0;      ///< the first so many of the real log; 0: all
  std::size_t validate_every = 200;
  std::size_t published_every = 5;  ///< steps between two looks of the published protocol
  int small_buffer = 300;           ///< of the pair that shows what forgetting does
  CrossValidationOptions grid;      ///< of the off-line baselines
  bool peers = true;                ///< the opponents' streams, where their files are there
  std::size_t threads = 0;          ///< 0: one per core; the results are the same

  /// Called now and then, from one thread at a time, with the share of the work that is done; false
  /// stops the work.
  std::function<bool(double)> keep_going = [](double) { return true; };

  /// Throws InputError naming what is out of range.
  void validate() const;
};

/// All of the paper's experiments at full length; about ten minutes on two cores.
ReproductionPlan full_plan();

/// The same, shortened to less than a minute: see its fields.
ReproductionPlan quick_plan();

/// One learner on one stream: its runs, one for each seed, each with all axes.
struct ContenderRuns {
  std::string key;
  std::string name;
  std::string settings;
  std::vector<std::vector<study::AxisResult>> seeds{};  ///< [seed][axis]
};

/// One stream under one split, and everybody who was on it.
struct StreamStudy {
  std::string key;  ///< "simulation", "real", or the further scenario's name
  bool simulated = true;
  std::string source;  ///< file of the scenario or the log
  std::string split;   ///< label
  std::string split_kind;
  double rate_hz = 0.0;
  std::size_t training_rows = 0;
  std::size_t held_out_rows = 0;  ///< with the first seed
  std::string note;               ///< what is special about the judged rows, or ""
  std::vector<int> configurations;
  std::vector<std::string> axes;
  std::vector<ContenderRuns> contenders;
  std::vector<OfflineMatrix> offline;  ///< per axis, first seed's rows; empty on further streams
};

/// Everything measured.
struct Reproduction {
  ReproductionPlan plan;
  bool real_log = false;
  bool interrupted = false;  ///< then the rest is not to be used
  std::vector<StreamStudy> studies;
  std::vector<PublishedRun> published;  ///< kelpie and its FIFO; empty without the whole log
  std::vector<PeerRun> peers;           ///< empty where the streams are absent
};

/// Runs the plan. Ensures: but for times of updates the result depends on the plan without
/// `threads` and `keep_going` alone. Throws InputError on a missing or wrong scenario or log.
Reproduction reproduce(const ReproductionPlan& plan);

}  // namespace kelpie::lab
