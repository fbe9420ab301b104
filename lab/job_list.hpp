// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "jobs/executor.hpp"
#include "lab/reproduction.hpp"

namespace kelpie::lab {

/// Begin and end of a part of the work, as shares of the whole.
struct ProgressPart {
  double from = 0.0;
  double to = 1.0;
};

/// Progress of a job, counted in cost.
class JobProgress {
 public:
  JobProgress(const jobs::Advance& advance, double planned)
      : advance_(advance), planned_(planned) {}

  /// Adds finished cost. False if the work has to stop.
  bool advance(double cost);
  bool stopped() const { return stopped_; }

 private:
  const jobs::Advance& advance_;
  double planned_;
  double done_ = 0.0;
  bool stopped_ = false;
};

/// A piece of work that reports finished cost to the progress.
struct ReproductionJob {
  double cost = 0.0;
  std::function<void(JobProgress&)> work;
};

/// Runs the jobs on the plan's threads (jobs::Executor); results stay in memory. False if the work
/// was stopped. Rethrows exceptions of jobs.
bool run_jobs(const std::vector<ReproductionJob>& list, const ReproductionPlan& plan,
              ProgressPart part);

}  // namespace kelpie::lab
