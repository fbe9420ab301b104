// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <exception>
#include <string>
#include <vector>

#include "jobs/progress.hpp"
#include "jobs/rank_parts.hpp"

namespace kelpie::jobs {

/// One run of a rank executor, seen by the rank that leads.
class RankLeader {
 public:
  /// Of a run and ranks that outlive it. left[rank]: that rank has said bye; kept up to date.
  RankLeader(Messenger& messenger, const Run& run, const std::string& version,
             std::vector<bool>& left);

  bool run();  ///< Executor::run() of the leader.

 private:
  enum class State { unknown, free, busy, refused };  // refused: no jobs for it

  void attend();
  void take(const Message& message);
  void take(const Outcome& outcome);
  void greet(std::size_t rank, const Greeting& other);
  void hand_out();
  Order next_order();
  void fail(std::exception_ptr error);
  void stop();
  bool settled() const;

  Messenger& messenger_;
  const Run& run_;
  Greeting mine_;
  std::vector<bool>& left_;
  std::vector<std::size_t> order_;
  std::size_t next_ = 0;  // in order_
  std::vector<State> ranks_;
  Progress progress_;
  std::exception_ptr error_;  // the first
  bool told_ = false;         // all who are busy know that the run is stopped
  Patience patience_;
  Occasion occasion_;
  JobThread own_;  // last: its job ends before what it uses
};

}  // namespace kelpie::jobs
