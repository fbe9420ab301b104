// SPDX-License-Identifier: Apache-2.0
#include "study/evaluator.hpp"

#include <algorithm>

#include "jobs/run_all.hpp"

namespace kelpie::study {

void Evaluator::run(const std::vector<Job>& jobs) {
  jobs::run_all(jobs.size(), options_.threads, [&](std::size_t i) {
    if (stopped_) {
      return;
    }
    try {
      make(jobs[i]);
    } catch (...) {
      stopped_ = true;  // or the other threads would finish their long jobs for nothing
      throw;
    }
  });
}

void Evaluator::make(const Job& job) {
  const std::size_t rows = chain_.rungs()[job.key.rung].rows;
  {
    const std::scoped_lock lock(mutex_);
    if (journal_.find(job.key)) {
      advance(rows);
      return;
    }
  }
  std::size_t shown = 0;
  const auto watch = [&](std::size_t more) {
    const std::scoped_lock lock(mutex_);
    shown += more;
    advance(more);
    return !stopped_;
  };
  const ChainScore result = chain_.score(
      job.key.rung, job.axis, [&] { return options_.make_learner(job.settings); },
      options_.most_iterations, watch);
  if (!result.stopped) {
    const std::scoped_lock lock(mutex_);
    journal_.add(job.key, result);
    advance(rows - shown);  // judged but not learned, or given up
  }
}

void Evaluator::advance(std::size_t rows) {
  rows_done_ += rows;
  const double share = static_cast<double>(rows_done_) / static_cast<double>(rows_planned_);
  stopped_ = !options_.keep_going(std::min(1.0, share)) || stopped_;
}

}  // namespace kelpie::study
