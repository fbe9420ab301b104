// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "live/output.hpp"

namespace kelpie::live {

/// Passes every result to several outputs, which may be replaced at run time. A mutex lets the
/// threads take turns.
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
  void health(const Health& health) override { pass(&Output::health, health); }
  void event(const std::string& line) override { pass(&Output::event, line); }
  void ended() override { pass(&Output::ended); }

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
  std::vector<std::unique_ptr<Output>> outputs_;
  std::vector<Output*> lasting_;
};

}  // namespace kelpie::live
