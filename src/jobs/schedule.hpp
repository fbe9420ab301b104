// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

namespace kelpie::jobs {

/// Where jobs are imagined to run: ranks of a rank engine, one of which leads.
struct ScheduleSettings {
  std::size_t ranks = 1;     ///< all of them work
  double message_s = 0.0;    ///< the leader's time for one result and the next order together
  double latency_s = 0.0;    ///< until a rank begins with its next job, beyond the leader's time
  double bytes_per_job = 0;  ///< of order and result
  double bytes_per_s = 1e9;  ///< that the leader's network carries
};

/// What would become of it.
struct Schedule {
  double makespan_s = 0.0;   ///< from the first order to the last result
  double efficiency = 0.0;   ///< the jobs' seconds over those of all ranks
  double leader_busy = 0.0;  ///< share of the makespan in which the leader sends or receives
};

/// Simulates jobs of so many `seconds`, begun in this order, each given to whoever is free next.
/// The leader speaks with one rank at a time; its own jobs cost it nothing to give. Requires
/// ranks > 0, seconds >= 0. Cost O(n log ranks).
Schedule simulate_schedule(std::span<const double> seconds, const ScheduleSettings& settings);

}  // namespace kelpie::jobs
