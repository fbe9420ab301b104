// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numeric>
#include <thread>
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

std::unique_ptr<Executor> make_thread_executor(std::size_t threads) {
  return std::make_unique<ThreadExecutor>(threads);
}

}  // namespace kelpie::jobs
