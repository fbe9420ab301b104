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

/// A part of a study that is run by itself: part `number` of `count`, from 1.
struct Part {
  std::size_t number = 1;
  std::size_t count = 1;

  auto operator<=>(const Part&) const = default;
  std::string text() const;  ///< "2/3"
  /// Throws InputError unless the text is k/n with 1 <= k <= n.
  static Part parse(const std::string& text);
};

/// What a process does with the results of a study.
enum class Access {
  run,   ///< runs what is missing
  read,  ///< reads what other processes have run, and writes nothing
};

/// Outcomes of a study's combinations. They stay in journals on disk, all in the study's folder:
/// journal.jsonl of a study run as a whole, journal.part-2-of-3.jsonl of a part.
class Results {
 public:
  /// Opens the journals in `folder`: its own for writing, or begins it (Access::run), the others
  /// for reading. A `part` has the combinations that jobs::deal_by_cost deals to it. Requires that
  /// plan and missions outlive the object. Throws as jobs::Journal does, also for a journal of
  /// another version of kelpie or of a study of another name.
  Results(const Plan& plan, const std::vector<Mission>& missions,
          const std::filesystem::path& folder, Access access = Access::run,
          std::optional<Part> part = {});

  const Plan& plan() const { return plan_; }
  const std::vector<Mission>& missions() const { return missions_; }
  const Combinations& combinations() const { return combinations_; }

  /// Runs what is missing (Worker), and tries again what failed before. False where keep_going, as
  /// jobs::Run has it, stopped it. Throws Failure where the journal can't be written.
  bool run(jobs::Executor& executor, const std::function<bool(double)>& keep_going);

  std::size_t assigned() const { return assigned_.size(); }  ///< combinations, of the part if any
  std::size_t done() const;  ///< assigned combinations that have an outcome
  /// Of combination i; none where it failed, or hasn't been run.
  std::optional<Outcome> outcome(std::size_t i) const;
  /// Why combinations have none, by number: those that run() tried, or with Access::read all.
  const std::map<std::size_t, std::string>& failures() const { return failures_; }

  /// The combinations with neither an outcome nor a failure, counted by the part that has to be run
  /// for them; one part 1/1 if there is no journal of a part.
  std::map<Part, std::size_t> missing() const;

 private:
  std::string key(std::size_t i) const { return key_of(plan_, missions_, combinations_[i]); }
  std::vector<jobs::Job> all_jobs() const;
  void open_others(const std::filesystem::path& folder, const jobs::JournalPlace& own);
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

/// Runs jobs of a study in a process that doesn't lead. `folder` is the study's.
void help(const Plan& plan, const std::filesystem::path& folder, jobs::Executor& executor,
          const std::function<bool(double)>& keep_going);

}  // namespace kelpie::fleet
