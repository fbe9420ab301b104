// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace kelpie::jobs {

/// A piece of work that depends on nothing but its task, so that any process may do it.
struct Job {
  std::string key;    ///< names it: no two of a list have the same
  std::string task;   ///< what to do, in the words of whoever made the list; JSON mostly
  double cost = 1.0;  ///< > 0: about how much work it is, in any unit
};

/// Tells how far a job is, 0 to 1. False: nobody waits for its result any more.
using Advance = std::function<bool(double share)>;

/// Does a job and gives its result. Called by any thread of any process, several at once.
using Work = std::function<std::string(const Job& job, const Advance& advance)>;

/// What an executor is asked for.
struct Run {
  std::span<const Job> jobs{};
  Work work;
  /// Takes the result of jobs[i]. Called in the process that leads, one at a time, in any order.
  std::function<void(std::size_t i, std::string result)> done{};
  /// Called now and then, one at a time, in the process that leads with the share of the work that
  /// is done; false stops the run. In the other processes the share is that of their own job.
  std::function<bool(double share)> keep_going = [](double) { return true; };
  /// What all processes have to agree in, in words: the program's version, what the jobs are of.
  std::string identity{};
};

/// Where jobs run: on threads of this process, or on many machines. All processes of a run make
/// the same call of run(); one of them leads: it has the jobs and takes the results.
class Executor {
 public:
  Executor() = default;
  virtual ~Executor() = default;
  Executor(const Executor&) = delete;
  Executor(Executor&&) = delete;
  Executor& operator=(const Executor&) = delete;
  Executor& operator=(Executor&&) = delete;

  /// Whether this process leads. The others have no terminal and no files to write: all they do is
  /// to call run(), whose `jobs` and `done` they needn't have, until it comes back.
  virtual bool leads() const = 0;
  /// How many jobs run at a time.
  virtual std::size_t workers() const = 0;

  /// Runs the jobs, the costly first, each given to whoever is free next, and comes back when none
  /// is left. False where keep_going stopped it: then jobs that were running have no result.
  /// What a job or `done` throws ends the run and is thrown here, in the process that leads.
  virtual bool run(const Run& run) = 0;
};

/// The jobs' places, the costly first; those that cost the same in their order. So no worker is
/// left alone with a long one in the end.
std::vector<std::size_t> costly_first(std::span<const Job> jobs);

/// On threads of this process; 0: one per core.
std::unique_ptr<Executor> make_thread_executor(std::size_t threads);

}  // namespace kelpie::jobs
