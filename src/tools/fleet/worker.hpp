// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "fleet/missions.hpp"
#include "fleet/plan.hpp"
#include "jobs/executor.hpp"
#include "log/dataset.hpp"

namespace kelpie::fleet {

/// A job of a study. The estimated cost is the
/// size of the log in bytes times a factor of the learner's buffer (kTuning.free_buffer), equal for
/// equal buffers, so that the jobs of a log stay together. A kind is a learner with a source.
jobs::Job job_of(const Plan& plan, const std::vector<Mission>& missions, const Combination& one);

/// Runs combinations in any thread: study::learn() for a row of the plan. Each thread keeps its
/// last log for the next job; threads share logs.
class Worker {
 public:
  /// Requires that plan and missions outlive the worker.
  Worker(const Plan& plan, const std::vector<Mission>& missions)
      : plan_(plan), missions_(missions) {}

  /// The outcome as JSON in one line (outcome_json), or an object with the message `error`; empty
  /// after a stop by `advance`.
  std::string operator()(const Combination& one, const jobs::Advance& advance);

 private:
  struct Held {
    std::mutex reading;
    std::shared_ptr<const log::Dataset> data;
  };

  std::shared_ptr<const log::Dataset> dataset(const Source& source, const std::string& file,
                                              const std::string& held_out_column);
  std::shared_ptr<Held> held(const std::string& name);

  const Plan& plan_;
  const std::vector<Mission>& missions_;
  std::mutex mutex_;
  std::map<std::string, std::weak_ptr<Held>> logs_;
  std::map<std::thread::id, std::shared_ptr<Held>> last_;
};

}  // namespace kelpie::fleet
