// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "jobs/executor.hpp"
#include "jobs/schedule.hpp"

namespace kelpie::lab {

/// Made-up jobs for whatever executor there is: half to one and a half times `job_ms` long.
struct FleetPlan {
  std::size_t jobs = 200;
  double job_ms = 50.0;
  std::size_t bytes = 100;  ///< of each result, beside its value and seconds
  bool idle = false;        ///< jobs sleep, rather than take so much of a processor's time
  /// As jobs::Run::keep_going.
  std::function<bool(double share)> keep_going = [](double) { return true; };
};

/// What an executor took for it. Of the jobs of this run alone, where others were in the journal.
struct FleetResult {
  std::size_t workers = 0;
  std::size_t found = 0;  ///< jobs whose results were in the journal before
  std::size_t done = 0;   ///< jobs of this run
  std::size_t sent = 0;   ///< those of them that other processes did
  double wall_s = 0.0;
  double job_s = 0.0;         ///< all jobs' own time on the wall
  double leader_us = 0.0;     ///< processor time of the thread that leads, the journal's too
  double leader_bytes = 0.0;  ///< by which the leader's memory has grown since the first result
  std::uint64_t journal_bytes = 0;
  std::uint32_t value = 0;  ///< the same for the same plan, whoever did which job when

  double efficiency() const;   ///< the jobs' time over that of all workers
  double overhead_ms() const;  ///< a job: what the workers' time is beyond the jobs' own
};

/// Runs what the journal has no result of. In processes that don't lead, `journal` isn't touched
/// and nothing is given back but an empty result. False in `complete`: it was stopped.
FleetResult run_fleet(jobs::Executor& executor, const FleetPlan& plan,
                      const std::filesystem::path& journal, bool& complete);

/// Job times for schedules.
struct FleetTimes {
  std::string source;           ///< in words
  std::vector<double> seconds;  ///< in the order of a journal or a draw
};

/// `seconds` of every result of a study's journal. Throws InputError (file, line) where it has
/// none.
FleetTimes read_fleet_times(const std::filesystem::path& journal);
/// So many times, drawn from those with replacement; the same for the same arguments.
FleetTimes draw_fleet_times(const FleetTimes& from, std::size_t count);
/// Of a lognormal distribution.
FleetTimes lognormal_fleet_times(double median_s, double sigma, std::size_t count);

/// The schedules of jobs whose cost is known (the longest first) and of those in the order given.
struct FleetSchedule {
  jobs::ScheduleSettings settings;
  jobs::Schedule longest_first;
  jobs::Schedule as_given;
};
std::vector<FleetSchedule> fleet_schedules(const FleetTimes& times,
                                           const std::vector<std::size_t>& ranks,
                                           jobs::ScheduleSettings settings);

}  // namespace kelpie::lab
