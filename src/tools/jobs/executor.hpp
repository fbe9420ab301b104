// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace kelpie::jobs {

/// A piece of work.
struct Job {
  double cost = 1.0;     ///< > 0: estimated amount of work, in any unit
  std::size_t kind = 0;  ///< estimates are comparable among jobs of a kind, rough between kinds
};

/// Progress report of a job, 0 to 1. False: the job has to end, the result is not needed.
using Advance = std::function<bool(double share)>;

/// Does jobs[i] and returns the result. Called by several threads at once.
using Work = std::function<std::string(std::size_t i, const Advance& advance)>;

/// Arguments of Executor::run().
struct Run {
  std::span<const Job> jobs{};
  Work work;
  /// Takes the result of jobs[i]. One call at a time, in any order.
  std::function<void(std::size_t i, std::string result)> done{};
  /// Called now and then, one call at a time, with the share of finished work. False stops the run.
  std::function<bool(double share)> keep_going = [](double) { return true; };
};

/// Runs jobs.
class Executor {
 public:
  Executor() = default;
  virtual ~Executor() = default;
  Executor(const Executor&) = delete;
  Executor& operator=(const Executor&) = delete;

  /// Runs the jobs, the costly first; a free thread takes the next job. Returns false if the run
  /// was stopped before the last result. An exception of a job or of `done` ends the run and is
  /// rethrown.
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
