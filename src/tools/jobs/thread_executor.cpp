// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <functional>
#include <numeric>
#include <queue>
#include <thread>
#include <unordered_map>
#include <utility>
#include <vector>

#include "jobs/executor.hpp"
#include "jobs/progress.hpp"
#include "jobs/run_all.hpp"

namespace kelpie::jobs {
namespace {

struct Bundle {
  double cost = 0.0;
  std::vector<std::size_t> jobs{};
};

// Longest processing time first; the costliest bundle first, none empty.
std::vector<Bundle> cut_into_bundles(std::span<const Job> jobs,
                                     const std::vector<std::size_t>& costly_first,
                                     std::size_t count) {
  std::vector<Bundle> bundles(std::min(count, costly_first.size()));
  using Load = std::pair<double, std::size_t>;  // cost so far, bundle; the least is on top
  std::priority_queue<Load, std::vector<Load>, std::greater<>> loads;
  for (std::size_t i = 0; i < bundles.size(); ++i) {
    loads.emplace(0.0, i);
  }
  for (const std::size_t job : costly_first) {
    Bundle& least = bundles[loads.top().second];
    least.jobs.push_back(job);
    least.cost += jobs[job].cost;
    loads.emplace(least.cost, loads.top().second);
    loads.pop();
  }
  std::ranges::stable_sort(bundles, std::greater{}, &Bundle::cost);
  return bundles;
}

class ThreadExecutor final : public Executor {
 public:
  explicit ThreadExecutor(std::size_t threads)
      : threads_(threads == 0 ? std::max(1U, std::thread::hardware_concurrency()) : threads) {}

  bool run(const Run& run) override {
    const std::vector<std::size_t> order = costly_first(run.jobs);
    Progress progress(run);
    run_all(order.size(), threads_, [&](std::size_t place) {
      if (progress.stopped()) {
        return;
      }
      const std::size_t i = order[place];
      try {
        progress.finish(i, run.work(i, [&](double share) { return progress.advance(i, share); }));
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
  std::vector<std::size_t> kinds;  // the kind with the costliest job first
  std::unordered_map<std::size_t, std::vector<std::size_t>> jobs_of;
  for (const std::size_t i : costly_first(jobs)) {
    std::vector<std::size_t>& same = jobs_of[jobs[i].kind];
    if (same.empty()) {
      kinds.push_back(jobs[i].kind);
    }
    same.push_back(i);
  }
  std::vector<double> loads(parts, 0.0);
  std::vector<std::size_t> part_of(jobs.size());
  for (const std::size_t kind : kinds) {
    const std::vector<Bundle> bundles = cut_into_bundles(jobs, jobs_of[kind], parts);
    std::vector<std::size_t> least_first(parts);
    std::iota(least_first.begin(), least_first.end(), std::size_t{0});
    std::ranges::stable_sort(least_first, {}, [&](std::size_t part) { return loads[part]; });
    for (std::size_t i = 0; i < bundles.size(); ++i) {
      loads[least_first[i]] += bundles[i].cost;
      for (const std::size_t job : bundles[i].jobs) {
        part_of[job] = least_first[i];
      }
    }
  }
  return part_of;
}

std::unique_ptr<Executor> make_thread_executor(std::size_t threads) {
  return std::make_unique<ThreadExecutor>(threads);
}

}  // namespace kelpie::jobs
