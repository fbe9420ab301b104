// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fleet/missions.hpp"
#include "fleet/outcome.hpp"
#include "fleet/plan.hpp"
#include "jobs/executor.hpp"
#include "jobs/journal.hpp"

namespace kelpie::fleet {

/// What has come of a study's combinations. Outcomes stay in the journal.
class Results {
 public:
  /// Opens the journal in `folder`, or begins it. Requires that plan and missions outlive it.
  /// Throws as Journal does; another version of kelpie's, or of a study of another name, is none
  /// to go on with.
  Results(const Plan& plan, const std::vector<Mission>& missions,
          const std::filesystem::path& folder);

  const Plan& plan() const { return plan_; }
  const std::vector<Mission>& missions() const { return missions_; }
  const Combinations& combinations() const { return combinations_; }

  /// Runs what is missing (Worker), and tries again what failed before. False where keep_going, as
  /// jobs::Run has it, stopped it. Throws Failure where the journal can't be written.
  bool run(jobs::Executor& executor, const std::function<bool(double)>& keep_going);

  std::size_t done() const;  ///< combinations that have an outcome
  /// Of combination i; none where it failed, or hasn't been run.
  std::optional<Outcome> outcome(std::size_t i) const;
  /// Why combinations have none, by number.
  const std::map<std::size_t, std::string>& failures() const { return failures_; }

 private:
  std::string key(std::size_t i) const { return key_of(plan_, missions_, combinations_[i]); }

  const Plan& plan_;
  const std::vector<Mission>& missions_;
  Combinations combinations_;
  jobs::Journal journal_;
  std::map<std::size_t, std::string> failures_;
};

/// What a process that doesn't lead does of a study.
void help(const Plan& plan, jobs::Executor& executor,
          const std::function<bool(double)>& keep_going);

inline constexpr const char* kJournalName = "journal.jsonl";  ///< of a study, in its folder

}  // namespace kelpie::fleet
