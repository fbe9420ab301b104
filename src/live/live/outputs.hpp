// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "live/event_limit.hpp"
#include "live/output.hpp"

namespace kelpie::live {

/// Passes every result to several outputs, which may be replaced at run time, and of the events as
/// many as EventLimit lets pass. A mutex lets the threads take turns.
class Outputs final : public Output {
 public:
  /// Adds an output that use() leaves alone. Requires that the output outlives this.
  void add(Output& lasting) {
    const std::lock_guard lock(mutex_);
    lasting_.push_back(&lasting);
  }

  /// Replaces the outputs of the previous call.
  void use(std::vector<std::unique_ptr<Output>> outputs) {
    const std::lock_guard lock(mutex_);
    outputs_.swap(outputs);  // the end of an output may take its time
  }

  bool wants_predictions() const override {
    const std::lock_guard lock(mutex_);
    const auto wants = [](const auto& output) { return output->wants_predictions(); };
    return std::ranges::any_of(outputs_, wants) || std::ranges::any_of(lasting_, wants);
  }
  void learned(const LearnedSample& sample) override { pass(&Output::learned, sample); }
  void predicted(const PredictedSample& sample) override { pass(&Output::predicted, sample); }
  void reckoned(const ReckonedSample& sample) override { pass(&Output::reckoned, sample); }
  void health(const Health& health) override {
    tell_left_out(std::chrono::steady_clock::now());
    pass(&Output::health, health);
  }
  void event(const std::string& line) override {
    std::unique_lock lock(mutex_);
    if (limit_.passes(line, std::chrono::steady_clock::now())) {
      lock.unlock();
      pass(&Output::event, line);
    }
  }
  void ended() override { pass(&Output::ended); }

  /// An event for each kind of event of which some were left out in a minute that has ended `now`.
  void tell_left_out(EventLimit::Time now) {
    std::unique_lock lock(mutex_);
    const std::vector<std::string> lines = limit_.left_out(now);
    lock.unlock();
    std::ranges::for_each(lines, [&](const std::string& line) { pass(&Output::event, line); });
  }

 private:
  template <typename... Result>
  void pass(void (Output::*function)(const Result&...), const Result&... result) {
    const std::lock_guard lock(mutex_);
    for (const std::unique_ptr<Output>& output : outputs_) {
      (output.get()->*function)(result...);
    }
    for (Output* const output : lasting_) {
      (output->*function)(result...);
    }
  }

  mutable std::mutex mutex_;
  EventLimit limit_;
  std::vector<std::unique_ptr<Output>> outputs_;
  std::vector<Output*> lasting_;
};

}  // namespace kelpie::live
