// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <mutex>
#include <string>
#include <vector>

#include "jobs/executor.hpp"

namespace kelpie::jobs {

/// Counts the work that is done while the jobs of a run go on. Safe from many threads; the run's
/// callbacks are called by one thread at a time.
class Progress {
 public:
  explicit Progress(const Run& run);  ///< Requires that the run outlives the object.

  /// Job i reports the share of its work that is done. The share counts at the next report if
  /// another thread is reporting. False if the run was stopped.
  bool advance(std::size_t i, double share);
  /// Job i has its result, which goes to Run::done unless the run was stopped.
  void finish(std::size_t i, std::string result);

  void stop() { stopped_ = true; }
  bool stopped() const { return stopped_; }

 private:
  bool reach(std::size_t i, double share);

  const Run& run_;
  std::mutex mutex_;
  std::vector<double> shares_;  // done, by job
  double planned_ = 0.0;
  double done_ = 0.0;
  std::atomic<int> finishing_{0};  // results waiting for the mutex
  std::atomic<bool> stopped_{false};
};

}  // namespace kelpie::jobs
