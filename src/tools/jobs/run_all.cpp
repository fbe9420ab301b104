// SPDX-License-Identifier: Apache-2.0
#include "jobs/run_all.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace kelpie::jobs {

void run_all(std::size_t count, std::size_t threads, const std::function<void(std::size_t)>& job) {
  std::atomic<std::size_t> next{0};
  std::atomic<bool> failed{false};
  std::mutex mutex;
  std::exception_ptr failure;
  const auto worker = [&] {
    try {
      for (std::size_t i = next++; i < count && !failed; i = next++) {
        job(i);
      }
    } catch (...) {
      const std::scoped_lock lock(mutex);
      failure = failure ? failure : std::current_exception();
      failed = true;
    }
  };
  {
    std::vector<std::jthread> pool;
    const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
    for (std::size_t i = 1; i < std::min(threads == 0 ? cores : threads, count); ++i) {
      pool.emplace_back(worker);
    }
    worker();
  }
  if (failure) {
    std::rethrow_exception(failure);
  }
}

bool run_while(const std::function<bool(double)>& keep_going, std::size_t count,
               std::size_t threads, const std::function<void(std::size_t)>& job) {
  std::atomic<bool> stopped{false};
  std::mutex mutex;
  std::size_t done = 0;
  run_all(count, threads, [&](std::size_t i) {
    if (stopped) {
      return;
    }
    job(i);
    const std::scoped_lock lock(mutex);
    stopped = !keep_going(static_cast<double>(++done) / static_cast<double>(count)) || stopped;
  });
  return !stopped;
}

}  // namespace kelpie::jobs
