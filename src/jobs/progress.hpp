// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <mutex>
#include <string>
#include <vector>

#include "jobs/executor.hpp"

namespace kelpie::jobs {

/// The work of a run that is done, counted while jobs run. Safe from many threads; progress and
/// results are told by one of them at a time.
class Progress {
 public:
  explicit Progress(const Run& run);  ///< Of a run that outlives it.

  /// Job i has come that far; counted with the next time where another job is being counted. False
  /// when the work is to stop.
  bool advance(std::size_t i, double share);
  /// Job i has its result, which is told unless the run was stopped.
  void finish(std::size_t i, std::string result);
  /// Asks whether to go on though nothing has moved. False when the work is to stop.
  bool look();

  void stop() { stopped_ = true; }
  bool stopped() const { return stopped_; }

 private:
  std::unique_lock<std::mutex> unless_in_use();
  bool reach(std::size_t i, double share);
  bool ask();

  const Run& run_;
  std::mutex mutex_;
  std::vector<double> shares_;  // of each job
  double planned_ = 0.0;
  double done_ = 0.0;
  std::atomic<int> finishing_{0};  // results that wait for the mutex
  std::atomic<bool> stopped_{false};
};

}  // namespace kelpie::jobs
