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

/// A piece of work with a result that depends on the task alone, so that any process can run it.
struct Job {
  std::string key;       ///< unique name in the list
  std::string task;      ///< description of the work; mostly JSON
  double cost = 1.0;     ///< > 0: estimated amount of work, in any unit
  std::size_t kind = 0;  ///< estimates are comparable among jobs of a kind, rough between kinds
};

/// Progress report of a job, 0 to 1. False: the job has to end, the result is not needed.
using Advance = std::function<bool(double share)>;

/// Does a job and returns the result: JSON in one line where several processes work together.
/// Called by any thread of any process, by several threads at once.
using Work = std::function<std::string(const Job& job, const Advance& advance)>;

/// Arguments of Executor::run().
struct Run {
  std::span<const Job> jobs{};
  Work work;
  /// Takes the result of jobs[i]. Called in the process that leads, one call at a time, in any
  /// order. Results of other processes arrive when all processes have ended their work.
  std::function<void(std::size_t i, std::string result)> done{};
  /// Called now and then, one call at a time, with the share of finished work (with several
  /// processes: of started work). False stops the run in every process.
  std::function<bool(double share)> keep_going = [](double) { return true; };
  /// Text about the origin of the jobs; must be equal in all processes.
  std::string identity{};
  /// Journal of the results, in a folder visible to all processes. With several processes, each
  /// process except the leading process keeps results in a file beside the journal (rank_journal).
  JournalPlace journal{};
};

/// Runs jobs on threads of a process, or in several processes on one or many machines. All
/// processes of a group call run() in the same order; the leading process has the jobs and takes
/// the results.
class Executor {
 public:
  Executor() = default;
  virtual ~Executor() = default;
  Executor(const Executor&) = delete;
  Executor& operator=(const Executor&) = delete;

  /// Whether this process leads. A process that does not lead prints nothing, writes no result
  /// files, and calls run() without `jobs` and `done`.
  virtual bool leads() const = 0;
  /// Number of jobs that run at a time, in all processes.
  virtual std::size_t workers() const = 0;

  /// Runs the jobs, the costly first; a free worker takes the next job. Returns false if the run
  /// was stopped before the last result. An exception of a job or of `done` ends the run and is
  /// rethrown in the leading process.
  virtual bool run(const Run& run) = 0;
};

/// Indices of the jobs, the costly first; jobs of equal cost in their order.
std::vector<std::size_t> costly_first(std::span<const Job> jobs);

/// Deals jobs to parts. The jobs of a kind are dealt to as many bundles as parts by longest
/// processing time first: in order of falling cost, each job goes to the bundle with the least cost
/// so far, the first of equals. Kind after kind, the kind with the costliest job first, the
/// costliest bundle goes to the part with the least cost so far. So every part has an equal share
/// of every kind, even where the costs of two kinds are in a wrong proportion. Returns the part, 0
/// to parts - 1, of each job. With a single kind the costliest part has at most 4/3 of the cost of
/// the best split (R. L. Graham, 1969). Requires parts > 0. Cost O(n log n + kinds parts log
/// parts).
std::vector<std::size_t> deal_by_cost(std::span<const Job> jobs, std::size_t parts);

/// On threads of this process; 0: one per core.
std::unique_ptr<Executor> make_thread_executor(std::size_t threads);

}  // namespace kelpie::jobs
