// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include "jobs/executor.hpp"
#include "jobs/messenger.hpp"

namespace kelpie::jobs {

inline constexpr std::size_t kLeader = 0;  ///< the rank that leads

/// What ranks send to each other. Numbers and the text of `hello` are for ever, so that ranks of
/// different versions understand as much as it takes to refuse each other.
enum class Kind : int {
  hello = 1,    ///< to the leader: ready for a run; a Greeting
  outcome = 2,  ///< to the leader: a job has ended; an Outcome
  halt = 3,     ///< to the leader: stop the run
  bye = 4,      ///< to the leader: there won't be a hello any more
  order = 5,    ///< from the leader: do this job; an Order
  stop = 6,     ///< from the leader: nobody waits for your job
  over = 7,     ///< from the leader: the run is over; "1" where it is complete
  gone = 8,     ///< from the leader: there won't be a run any more
};

/// Who is ready for which run.
struct Greeting {
  std::string host;
  std::string version;
  std::string identity;

  std::string text() const { return host + '\n' + version + '\n' + identity; }
  static Greeting of(std::string_view text);  ///< Of any text.
};

/// jobs[place] of the leader's list.
struct Order {
  std::size_t place = 0;
  Job job;

  std::string text() const;
  static Order of(std::string_view text);
};

/// How jobs[place] ended.
struct Outcome {
  enum class How : int { result, stopped, bad_input, failed };
  std::size_t place = 0;
  How how = How::result;
  std::string said;  ///< the result, or what was thrown

  std::string text() const;
  static Outcome of(std::string_view text);
  /// What was thrown; requires bad_input or failed.
  std::exception_ptr error() const;
};

/// Does one job at a time, in a thread of its own, always the same.
class JobThread {
 public:
  JobThread() = default;
  ~JobThread();
  JobThread(const JobThread&) = delete;
  JobThread(JobThread&&) = delete;
  JobThread& operator=(const JobThread&) = delete;
  JobThread& operator=(JobThread&&) = delete;

  bool busy() const { return busy_; }
  /// Requires !busy(), and `work` and `advance` that live until its outcome was taken.
  void begin(Order order, const Work& work, Advance advance);
  /// The outcome of the job, once it has ended; waits for so long, also without a job. What `work`
  /// gives after `advance` has said false counts as stopped.
  std::optional<Outcome> wait(std::chrono::microseconds time);

 private:
  void run();

  bool busy_ = false;  // as the thread knows that calls
  std::mutex mutex_;
  std::condition_variable changed_;
  std::function<Outcome()> task_;
  std::optional<Outcome> outcome_;
  bool ended_ = false;
  std::jthread thread_;  // last: it uses the others
};

/// How long to sleep until one looks for messages again: a tenth of the time since the last.
class Patience {
 public:
  void heard() { since_ = std::chrono::steady_clock::now(); }
  std::chrono::microseconds next() const;

 private:
  std::chrono::steady_clock::time_point since_ = std::chrono::steady_clock::now();
};

/// Tells when Run::keep_going is to be asked though nothing has moved: every 50 ms.
class Occasion {
 public:
  bool due();

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace kelpie::jobs
