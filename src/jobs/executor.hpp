// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "jobs/journal.hpp"

namespace kelpie::jobs {

/// A piece of work whose result depends on its task alone, so that any process may do the work.
struct Job {
  std::string key;    ///< unique name in the list
  std::string task;   ///< the work as text, in a format of the list's author; JSON mostly
  double cost = 1.0;  ///< > 0: estimated amount of work, in any unit
};

/// A job reports its progress, 0 to 1. False: the job has to end, its result is not needed.
using Advance = std::function<bool(double share)>;

/// Does a job and returns the result: JSON in one line where several processes work together.
/// Called by any thread of any process, by several at once.
using Work = std::function<std::string(const Job& job, const Advance& advance)>;

/// Arguments of Executor::run().
struct Run {
  std::span<const Job> jobs{};
  Work work;
  /// Takes the result of jobs[i]. Called in the process that leads, one call at a time, in any
  /// order. Results of other processes arrive when all processes have ended their work.
  std::function<void(std::size_t i, std::string result)> done{};
  /// Called now and then, one call at a time, with the share of the work that is done (with several
  /// processes: begun). False stops the run in every process.
  std::function<bool(double share)> keep_going = [](double) { return true; };
  /// Text that must agree between all processes: what the jobs belong to.
  std::string identity{};
  /// Journal of the results. With several processes each but the leading one keeps its results in
  /// a file beside this one (rank_journal), which has to be in a folder that all processes see.
  JournalPlace journal{};
};

/// Runs jobs on threads of this process, or in several processes on one or many machines. All
/// processes of a group call run() in the same order; one of them leads: it has the jobs and takes
/// the results.
class Executor {
 public:
  Executor() = default;
  virtual ~Executor() = default;
  Executor(const Executor&) = delete;
  Executor(Executor&&) = delete;
  Executor& operator=(const Executor&) = delete;
  Executor& operator=(Executor&&) = delete;

  /// Whether this process leads. The other processes print nothing, write no result files, and call
  /// run() without `jobs` and `done`.
  virtual bool leads() const = 0;
  /// Number of jobs that run at a time, in all processes.
  virtual std::size_t workers() const = 0;

  /// Runs the jobs, the costly first; a free worker takes the next job. Returns false if the run
  /// was stopped before the last result. What a job or `done` throws ends the run and is thrown by
  /// the process that leads.
  virtual bool run(const Run& run) = 0;
};

/// Indices of the jobs, the costly first; jobs of equal cost in their order.
std::vector<std::size_t> costly_first(std::span<const Job> jobs);

/// The part, 0 to parts - 1, that each job belongs to: the costly first, each job to the part with
/// the least cost so far, the first of equals (longest processing time first). The costliest part
/// has at most 4/3 of the cost of the best split. Requires parts > 0. Cost O(n log n + n log
/// parts).
std::vector<std::size_t> deal_by_cost(std::span<const Job> jobs, std::size_t parts);

/// On threads of this process; 0: one per core.
std::unique_ptr<Executor> make_thread_executor(std::size_t threads);

}  // namespace kelpie::jobs
