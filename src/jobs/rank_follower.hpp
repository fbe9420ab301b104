// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <string>

#include "jobs/rank_parts.hpp"

namespace kelpie::jobs {

/// One run of a rank executor, seen by a rank that doesn't lead.
class RankFollower {
 public:
  RankFollower(Messenger& messenger, const Run& run)  ///< Of a run and ranks that outlive it.
      : messenger_(messenger), run_(run) {}
  ~RankFollower() { stopped_ = true; }
  RankFollower(const RankFollower&) = delete;
  RankFollower(RankFollower&&) = delete;
  RankFollower& operator=(const RankFollower&) = delete;
  RankFollower& operator=(RankFollower&&) = delete;

  /// Executor::run() of this rank; nothing where the leader has gone.
  std::optional<bool> run(const std::string& version);

 private:
  void attend();
  void take(const Message& message);
  bool advance(double share);
  void look();
  void ask();

  Messenger& messenger_;
  const Run& run_;
  std::mutex mutex_;  // of keep_going
  double share_ = 0.0;
  std::atomic<bool> stopped_{false};    // nobody waits for this rank's job
  std::atomic<bool> unwilling_{false};  // keep_going has said no
  bool halted_ = false;                 // the leader knows
  std::optional<Message> end_;
  Patience patience_;
  Occasion occasion_;
  JobThread own_;  // last: its job ends before what it uses
};

}  // namespace kelpie::jobs
