// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "jobs/executor.hpp"
#include "lab/reproduction.hpp"

namespace kelpie::lab {

/// A part of all the work, as shares of it.
struct ProgressPart {
  double from = 0.0;
  double to = 1.0;
};

/// Counts what a job has done, and hears whether to go on.
class Watch {
 public:
  Watch(const jobs::Advance& advance, double planned) : advance_(advance), planned_(planned) {}

  /// False when the work is to stop.
  bool advance(double cost);
  bool stopped() const { return stopped_; }

 private:
  const jobs::Advance& advance_;
  double planned_;
  double done_ = 0.0;
  bool stopped_ = false;
};

/// A piece of work that reports its cost to the watch as it goes.
struct ReproductionJob {
  double cost = 0.0;
  std::function<void(Watch&)> work;
};

/// Runs the jobs on an executor of the plan's threads, in whose process their results stay. False
/// when the work was stopped. Throws what a job throws.
bool run_jobs(const std::vector<ReproductionJob>& list, const ReproductionPlan& plan,
              ProgressPart part);

}  // namespace kelpie::lab
