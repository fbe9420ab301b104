// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "fleet/plan.hpp"

namespace kelpie::fleet {

/// A log of a fleet.
struct Mission {
  std::filesystem::path file;  ///< absolute; a folder for a bag of several files
  std::string log;             ///< the same path, relative to the study's folder
  std::string vehicle;         ///< named by the source, by the pattern, or by the log's folder
  std::string mission;         ///< named by the pattern, or equal to `log`
  std::size_t source = 0;      ///< of Plan::sources
  std::uintmax_t bytes = 0;
  std::int64_t changed_ns = 0;  ///< time of the last write
};

/// Logs matched by the plan's patterns, sorted by vehicle and log; numbers in names sort by value,
/// dive9 before dive10. Throws InputError (file, line) naming a pattern without matches or a log of
/// two vehicles; Failure on errors of the file system.
std::vector<Mission> find_missions(const Plan& plan);

/// A combination of a study: a learner on a log with a split.
struct Combination {
  std::size_t mission = 0;  ///< index in the list of missions
  std::size_t split = 0;    ///< of Plan::splits
  std::size_t learner = 0;  ///< of Plan::learners
};

/// All combinations of a study, by number. The combinations of a log are consecutive.
class Combinations {
 public:
  /// The plan's splits and learners with `missions` logs.
  Combinations(const Plan& plan, std::size_t missions)
      : splits_(plan.splits.size()), learners_(plan.learners.size()), missions_(missions) {}

  std::size_t size() const { return missions_ * splits_ * learners_; }
  /// Requires i < size().
  Combination operator[](std::size_t i) const {
    return {i / (splits_ * learners_), i / learners_ % splits_, i % learners_};
  }

 private:
  std::size_t splits_;
  std::size_t learners_;
  std::size_t missions_;
};

/// Key of the combination's result in a journal. Changes with everything the result depends on: the
/// log's size and time, options of reading, the learner's settings.
std::string key_of(const Plan& plan, std::span<const Mission> missions, const Combination& one);

}  // namespace kelpie::fleet
