// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fleet/missions.hpp"
#include "fleet/outcome.hpp"
#include "fleet/plan.hpp"
#include "jobs/executor.hpp"
#include "jobs/journal.hpp"

namespace kelpie::fleet {

inline constexpr const char* kJournalName = "journal.jsonl";  ///< of a study, in its folder

/// A part of a study for a process of its own: part `number` of `count`, from 1.
struct Part {
  std::size_t number = 1;
  std::size_t count = 1;

  auto operator<=>(const Part&) const = default;
  std::string text() const;  ///< "2/3"
  /// Throws InputError unless the text is k/n with 1 <= k <= n.
  static Part parse(const std::string& text);
};

/// Use of a study's journals by a process.
enum class Access {
  run,   ///< runs missing combinations
  read,  ///< reads the results of other processes, writes nothing
};

/// Outcomes of a study's combinations. Outcomes stay on disk, in the journals of the study's
/// folder: journal.jsonl of a study run as a whole, journal.part-2-of-3.jsonl of a part.
class Results {
 public:
  /// Opens or begins the process's own journal in `folder` for writing (Access::run), and all
  /// further journals for reading. jobs::deal_by_cost assigns combinations to a `part`; without a
  /// part every combination is assigned. Requires that plan and missions outlive the object. Throws
  /// as jobs::Journal does, also for a journal of another version of kelpie or of a study of
  /// another name.
  Results(const Plan& plan, const std::vector<Mission>& missions,
          const std::filesystem::path& folder, Access access = Access::run,
          std::optional<Part> part = {});

  const Plan& plan() const { return plan_; }
  const std::vector<Mission>& missions() const { return missions_; }
  const Combinations& combinations() const { return combinations_; }

  /// Runs the assigned combinations without an outcome (Worker); combinations that failed before
  /// are tried again. False if keep_going (jobs::Run) stopped the run. Requires Access::run. Throws
  /// Failure if the journal cannot be written.
  bool run(jobs::Executor& executor, const std::function<bool(double)>& keep_going);

  std::size_t assigned() const { return assigned_.size(); }  ///< number of combinations
  std::size_t done() const;  ///< assigned combinations with an outcome
  /// Outcome of combination i; empty if the combination failed or has not been run.
  std::optional<Outcome> outcome(std::size_t i) const;
  /// Errors of failed combinations, by number: failures of run(), or, with Access::read, failures
  /// in the journals.
  const std::map<std::size_t, std::string>& failures() const { return failures_; }

  /// Number of combinations without outcome and failure, by part. The number of parts is taken from
  /// the latest journal of a part; part 1/1 without such a journal.
  std::map<Part, std::size_t> missing() const;

 private:
  std::string key(std::size_t i) const { return key_of(plan_, missions_, combinations_[i]); }
  std::vector<jobs::Job> all_jobs() const;
  void open_others(const std::filesystem::path& folder, const std::string& own);
  void look_up();
  void enter(std::size_t i, const std::string& result);

  const Plan& plan_;
  const std::vector<Mission>& missions_;
  Combinations combinations_;
  std::vector<std::size_t> assigned_;
  std::unique_ptr<jobs::Journal> own_;                        // none with Access::read
  std::vector<std::unique_ptr<jobs::JournalReader>> others_;  // the latest first
  std::vector<const jobs::JournalReader*> found_;             // of each combination
  std::map<std::size_t, std::string> failures_;
  std::size_t parts_ = 1;  // of the latest journal of a part
};

}  // namespace kelpie::fleet
