// SPDX-License-Identifier: Apache-2.0
#include "jobs/progress.hpp"

#include <algorithm>
#include <utility>

namespace kelpie::jobs {

Progress::Progress(const Run& run) : run_(run), shares_(run.jobs.size(), 0.0) {
  for (const Job& job : run.jobs) {
    planned_ += job.cost;
  }
}

// Jobs may report without a pause; a job that has a result must not wait for them.
bool Progress::advance(std::size_t i, double share) {
  if (finishing_ > 0) {
    return !stopped_;
  }
  const std::unique_lock lock(mutex_, std::try_to_lock);
  return lock ? reach(i, share) : !stopped_;
}

void Progress::finish(std::size_t i, std::string result) {
  ++finishing_;
  const std::scoped_lock lock(mutex_);
  --finishing_;
  if (!stopped_) {
    run_.done(i, std::move(result));
    reach(i, 1.0);
  }
}

bool Progress::reach(std::size_t i, double share) {
  share = std::clamp(share, shares_[i], 1.0);
  done_ += (share - shares_[i]) * run_.jobs[i].cost;
  shares_[i] = share;
  const double all = planned_ > 0.0 ? std::min(1.0, done_ / planned_) : 1.0;
  if (!stopped_ && !run_.keep_going(all)) {
    stopped_ = true;  // never set to false: stop() may have come in between
  }
  return !stopped_;
}

}  // namespace kelpie::jobs
