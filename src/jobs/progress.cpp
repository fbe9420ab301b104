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

bool Progress::advance(std::size_t i, double share) {
  const std::unique_lock lock = unless_in_use();
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

bool Progress::look() {
  const std::unique_lock lock = unless_in_use();
  return lock ? ask() : !stopped_;
}

// Jobs may tell how far they are without a pause: who has a result mustn't have to wait for one.
std::unique_lock<std::mutex> Progress::unless_in_use() {
  return finishing_ > 0 ? std::unique_lock<std::mutex>()
                        : std::unique_lock<std::mutex>(mutex_, std::try_to_lock);
}

bool Progress::reach(std::size_t i, double share) {
  share = std::clamp(share, shares_[i], 1.0);
  done_ += (share - shares_[i]) * run_.jobs[i].cost;
  shares_[i] = share;
  return ask();
}

bool Progress::ask() {
  const double share = planned_ > 0.0 ? std::min(1.0, done_ / planned_) : 1.0;
  if (!stopped_ && !run_.keep_going(share)) {
    stopped_ = true;  // written only where it is so: stop() may come in between
  }
  return !stopped_;
}

}  // namespace kelpie::jobs
