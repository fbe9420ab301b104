// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <functional>
#include <numeric>
#include <queue>
#include <thread>
#include <utility>
#include <vector>

#include "jobs/executor.hpp"
#include "jobs/progress.hpp"
#include "jobs/run_all.hpp"

namespace kelpie::jobs {
namespace {

class ThreadExecutor final : public Executor {
 public:
  explicit ThreadExecutor(std::size_t threads)
      : threads_(threads == 0 ? std::max(1U, std::thread::hardware_concurrency()) : threads) {}

  bool leads() const override { return true; }
  std::size_t workers() const override { return threads_; }

  bool run(const Run& run) override {
    const std::vector<std::size_t> order = costly_first(run.jobs);
    Progress progress(run);
    run_all(order.size(), threads_, [&](std::size_t place) {
      if (progress.stopped()) {
        return;
      }
      const std::size_t i = order[place];
      try {
        progress.finish(
            i, run.work(run.jobs[i], [&](double share) { return progress.advance(i, share); }));
      } catch (...) {
        progress.stop();  // or the other threads would finish their long jobs for nothing
        throw;
      }
    });
    return !progress.stopped();
  }

 private:
  std::size_t threads_;
};

}  // namespace

std::vector<std::size_t> costly_first(std::span<const Job> jobs) {
  std::vector<std::size_t> order(jobs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater{}, [&](std::size_t i) { return jobs[i].cost; });
  return order;
}

std::vector<std::size_t> deal_by_cost(std::span<const Job> jobs, std::size_t parts) {
  using Load = std::pair<double, std::size_t>;  // cost so far, part; the least is on top
  std::priority_queue<Load, std::vector<Load>, std::greater<>> loads;
  for (std::size_t part = 0; part < parts; ++part) {
    loads.emplace(0.0, part);
  }
  std::vector<std::size_t> part_of(jobs.size());
  for (const std::size_t i : costly_first(jobs)) {
    const auto [cost, part] = loads.top();
    loads.pop();
    part_of[i] = part;
    loads.emplace(cost + jobs[i].cost, part);
  }
  return part_of;
}

std::unique_ptr<Executor> make_thread_executor(std::size_t threads) {
  return std::make_unique<ThreadExecutor>(threads);
}

}  // namespace kelpie::jobs
