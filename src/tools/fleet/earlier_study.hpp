// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <unordered_map>
#include <vector>

#include "fleet/results.hpp"
#include "fleet/summary.hpp"

namespace kelpie::fleet {

/// Final R² on held-out rows of the runs of an earlier study.
struct EarlierStudy {
  std::string file;
  std::string kelpie;  ///< version of kelpie that ran the study
  /// By log, split, seed, learner and axis (run_name); NaN for a run without R².
  std::unordered_map<std::string, double> r2;
};

/// Name of a run on an axis, the same in both studies.
std::string run_name(const std::string& log, const std::string& split, std::uint64_t seed,
                     const std::string& learner, const std::string& axis);

/// Reads a study.json. Throws InputError (file, key) on any other content.
EarlierStudy read_earlier_study(const std::filesystem::path& file);

/// Change of a learner on a vehicle's axis: final R² on held-out rows, now minus then, over the
/// runs common to both studies.
struct Gain {
  std::string vehicle;
  std::string axis;
  std::string learner;
  Spread difference;
  Duel now;              ///< runs clearly better, or worse, than then
  std::size_t lost = 0;  ///< runs with an R² then and without now
};

/// A run common to both studies.
struct ChangedRun {
  std::size_t combination = 0;
  std::string axis;
  double then = kNoValue;
  double now = kNoValue;
};

/// A study beside an earlier one.
struct StudyChange {
  std::string file;           ///< of the earlier study
  std::string kelpie;         ///< version of kelpie of the earlier study
  std::vector<Gain> gains{};  ///< the least median first
  std::vector<ChangedRun>
      worst{};  ///< runs with the largest losses, the largest first; at most kTuning.worst_runs
  std::size_t matched = 0;  ///< runs' axes common to both studies
  std::size_t only_now = 0;
  std::size_t only_then = 0;
};

/// Throws InputError if the studies have no run in common.
StudyChange compare_studies(const Results& results, EarlierStudy earlier);

/// Gains with a median below −`most` or with a lost run.
std::vector<Gain> losses(const StudyChange& change, double most);

}  // namespace kelpie::fleet
