// SPDX-License-Identifier: Apache-2.0
#include "lab/job_list.hpp"

#include <string>

namespace kelpie::lab {

bool JobProgress::advance(double cost) {
  done_ += cost;
  stopped_ = stopped_ || !advance_(done_ / planned_);
  return !stopped_;
}

bool run_jobs(const std::vector<ReproductionJob>& list, const ReproductionPlan& plan,
              ProgressPart part) {
  std::vector<jobs::Job> named;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string place = std::to_string(i);
    named.push_back({place, place, list[i].cost});
  }
  return jobs::make_thread_executor(plan.threads)
      ->run({
          .jobs = named,
          .work =
              [&](const jobs::Job& job, const jobs::Advance& advance) {
                const ReproductionJob& one = list[std::stoul(job.task)];
                JobProgress progress(advance, one.cost);
                one.work(progress);
                return std::string();
              },
          .done = [](std::size_t, const std::string&) {},
          .keep_going =
              [&](double share) {
                return plan.keep_going(part.from + (part.to - part.from) * share);
              },
      });
}

}  // namespace kelpie::lab
