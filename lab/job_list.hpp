// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <vector>

#include "lab/reproduction.hpp"

namespace kelpie::lab {

/// A part of all the work, as shares of it.
struct ProgressPart {
  double from = 0.0;
  double to = 1.0;
};

/// Counts what jobs have done, and hears whether to go on. Safe from many threads.
class Watch {
 public:
  Watch(const ReproductionPlan& plan, ProgressPart part, double planned)
      : plan_(plan), part_(part), planned_(planned) {}

  /// False when the work is to stop.
  bool advance(double cost);
  bool stopped() const { return stopped_; }

 private:
  const ReproductionPlan& plan_;
  std::mutex mutex_;
  ProgressPart part_;
  double planned_;
  double done_ = 0.0;
  std::atomic<bool> stopped_{false};
};

/// A piece of work that reports its cost to the watch as it goes.
struct ReproductionJob {
  double cost = 0.0;
  std::function<void(Watch&)> work;
};

/// Runs the jobs on the plan's threads, the costly first, so that no thread is left alone with a
/// long one at the end. False when the work was stopped. Throws what a job throws.
bool run_jobs(std::vector<ReproductionJob> jobs, const ReproductionPlan& plan, ProgressPart part);

}  // namespace kelpie::lab
