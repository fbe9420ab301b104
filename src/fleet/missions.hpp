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

/// One log of a fleet.
struct Mission {
  std::filesystem::path file;  ///< absolute; a folder where it is a bag of several files
  std::string log;             ///< the same from the study's folder
  std::string vehicle;         ///< as named, as in the pattern, or the folder it lies in
  std::string mission;         ///< as in the pattern, or `log`
  std::size_t source = 0;      ///< of Plan::sources
  std::uintmax_t bytes = 0;
  std::int64_t changed_ns = 0;  ///< when it was written last
};

/// The logs that the plan's patterns find, by vehicle and then by log; numbers in names count as
/// numbers, dive9 before dive10. Throws InputError (file, line) naming a pattern that matches
/// nothing, and a log that two vehicles have; Failure where the file system fails.
std::vector<Mission> find_missions(const Plan& plan);

/// One combination of a study: a learner on a log whose rows are split.
struct Combination {
  std::size_t mission = 0;  ///< place in the list
  std::size_t split = 0;    ///< of Plan::splits
  std::size_t learner = 0;  ///< of Plan::learners
};

/// All combinations of a study, by number: those of a log lie together.
class Combinations {
 public:
  /// Of the plan's splits and learners with so many missions.
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

/// What a result of this combination is called in a journal. It changes with whatever the result
/// depends on: the log's size and time, how it is read, the learner's settings.
std::string key_of(const Plan& plan, std::span<const Mission> missions, const Combination& one);

}  // namespace kelpie::fleet
