// SPDX-License-Identifier: Apache-2.0
#include "evaluator.hpp"

#include <algorithm>
#include <exception>
#include <thread>

namespace kelpie {

void Evaluator::run(const std::vector<Job>& jobs) {
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  const auto worker = [&] {
    try {
      for (std::size_t i = next++; i < jobs.size() && !stopped_; i = next++) {
        make(jobs[i]);
      }
    } catch (...) {
      const std::scoped_lock lock(mutex_);
      failure = std::current_exception();
      stopped_ = true;
    }
  };
  {
    std::vector<std::jthread> pool;
    const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
    const std::size_t threads = options_.threads == 0 ? cores : options_.threads;
    for (std::size_t i = 1; i < std::min(threads, jobs.size()); ++i) {
      pool.emplace_back(worker);
    }
    worker();
  }
  if (failure) {
    std::rethrow_exception(failure);
  }
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

}  // namespace kelpie
