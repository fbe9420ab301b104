// SPDX-License-Identifier: Apache-2.0
#include "jobs/schedule.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <queue>
#include <utility>
#include <vector>

namespace kelpie::jobs {

Schedule simulate_schedule(std::span<const double> seconds, const ScheduleSettings& settings) {
  // When a rank has ended its job; the first is on top.
  using Ended = std::pair<double, std::size_t>;
  std::priority_queue<Ended, std::vector<Ended>, std::greater<>> ranks;
  for (std::size_t rank = 0; rank < settings.ranks; ++rank) {
    ranks.emplace(0.0, rank);
  }
  const double talk_s = settings.message_s + settings.bytes_per_job / settings.bytes_per_s;
  double leader_free_s = 0.0;
  double talked_s = 0.0;
  double end_s = 0.0;
  const auto talk = [&](double since_s) {
    leader_free_s = std::max(leader_free_s, since_s) + talk_s;
    talked_s += talk_s;
    return leader_free_s;
  };
  for (const double job_s : seconds) {
    const auto [free_s, rank] = ranks.top();
    ranks.pop();
    const double begin_s = rank == 0 ? free_s : talk(free_s) + settings.latency_s;
    ranks.emplace(begin_s + job_s, rank);
    end_s = std::max(end_s, begin_s + job_s);
  }
  const double sum_s = std::accumulate(seconds.begin(), seconds.end(), 0.0);
  return {end_s, end_s > 0.0 ? sum_s / (end_s * static_cast<double>(settings.ranks)) : 1.0,
          end_s > 0.0 ? talked_s / end_s : 0.0};
}

}  // namespace kelpie::jobs
