// SPDX-License-Identifier: Apache-2.0
#include "lab/job_list.hpp"

#include <algorithm>

#include "jobs/run_all.hpp"

namespace kelpie::lab {

bool Watch::advance(double cost) {
  const std::scoped_lock lock(mutex_);
  done_ += cost;
  const double share = std::min(1.0, done_ / planned_);
  stopped_ = stopped_ || !plan_.keep_going(part_.from + (part_.to - part_.from) * share);
  return !stopped_;
}

bool run_jobs(std::vector<ReproductionJob> jobs, const ReproductionPlan& plan, ProgressPart part) {
  std::ranges::stable_sort(jobs, std::greater{}, &ReproductionJob::cost);
  double cost = 1.0;
  for (const ReproductionJob& job : jobs) {
    cost += job.cost;
  }
  Watch watch(plan, part, cost);
  jobs::run_all(jobs.size(), plan.threads, [&](std::size_t i) {
    if (!watch.stopped()) {
      jobs[i].work(watch);
    }
  });
  return !watch.stopped();
}

}  // namespace kelpie::lab
