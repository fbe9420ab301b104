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

/// R² on held-out rows, at the end, of an earlier study's runs.
struct EarlierStudy {
  std::string file;
  std::string kelpie;  ///< the version that made it
  /// By log, split, seed, learner and axis (run_name); NaN where it had none.
  std::unordered_map<std::string, double> r2;
};

/// What a run is called in both studies.
std::string run_name(const std::string& log, const std::string& split, std::uint64_t seed,
                     const std::string& learner, const std::string& axis);

/// Reads a study.json. Throws InputError (file, key) on what isn't one.
EarlierStudy read_earlier_study(const std::filesystem::path& file);

/// What a learner has gained, or lost, on a vehicle's axis: R² on held-out rows at the end, now
/// less then, over the runs that both studies have.
struct Gain {
  std::string vehicle;
  std::string axis;
  std::string learner;
  Spread difference;
  Duel now;              ///< runs that are clearly better, or worse, than they were
  std::size_t lost = 0;  ///< runs that had an R² then and have none now
};

/// One run in both.
struct ChangedRun {
  std::size_t combination = 0;
  std::string axis;
  double then = kNoValue;
  double now = kNoValue;
};

/// A study beside an earlier one.
struct StudyChange {
  std::string file;                 ///< of the earlier one
  std::string kelpie;               ///< its version
  std::vector<Gain> gains{};        ///< the least median first
  std::vector<ChangedRun> worst{};  ///< runs that lost most, the most first; kWorstRuns at most
  std::size_t matched = 0;          ///< runs, each on an axis, that both have
  std::size_t only_now = 0;
  std::size_t only_then = 0;
};

/// Throws InputError where the two have no run in common.
StudyChange compare_studies(const Results& results, EarlierStudy earlier);

/// Those of the gains whose median is below −`most`, or that have lost a run.
std::vector<Gain> losses(const StudyChange& change, double most);

}  // namespace kelpie::fleet
