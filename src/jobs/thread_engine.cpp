// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <mutex>
#include <numeric>
#include <thread>
#include <utility>
#include <vector>

#include "jobs/engine.hpp"
#include "jobs/run_all.hpp"

namespace kelpie::jobs {
namespace {

// The work that is done, counted while jobs run. Under one mutex: progress and results are told by
// one thread at a time.
class Progress {
 public:
  explicit Progress(const Run& run) : run_(run), shares_(run.jobs.size(), 0.0) {
    for (const Job& job : run.jobs) {
      planned_ += job.cost;
    }
  }

  bool advance(std::size_t job, double share) {
    const std::scoped_lock lock(mutex_);
    return reach(job, share);
  }

  void finish(std::size_t job, std::string result) {
    const std::scoped_lock lock(mutex_);
    if (!stopped_) {
      run_.done(job, std::move(result));
      reach(job, 1.0);
    }
  }

  void stop() { stopped_ = true; }
  bool stopped() const { return stopped_; }

 private:
  bool reach(std::size_t job, double share) {
    share = std::clamp(share, shares_[job], 1.0);
    done_ += (share - shares_[job]) * run_.jobs[job].cost;
    shares_[job] = share;
    stopped_ = stopped_ || !run_.keep_going(std::min(1.0, done_ / planned_));
    return !stopped_;
  }

  const Run& run_;
  std::mutex mutex_;
  std::vector<double> shares_;  // of each job
  double planned_ = 0.0;
  double done_ = 0.0;
  std::atomic<bool> stopped_{false};
};

class ThreadEngine final : public Engine {
 public:
  explicit ThreadEngine(std::size_t threads)
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

std::unique_ptr<Engine> make_thread_engine(std::size_t threads) {
  return std::make_unique<ThreadEngine>(threads);
}

}  // namespace kelpie::jobs
