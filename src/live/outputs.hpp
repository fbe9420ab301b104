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

/// Tells all that it is told to several outputs, which may come and go: one thread after the other.
class Outputs final : public Output {
 public:
  /// This one as well, whatever use() says later. It has to outlive this.
  void add(Output& lasting) {
    const std::lock_guard lock(mutex_);
    lasting_.push_back(&lasting);
  }

  /// These instead of those before.
  void use(std::vector<std::unique_ptr<Output>> outputs) {
    const std::lock_guard lock(mutex_);
    outputs_ = std::move(outputs);
  }

  bool wants_predictions() const override {
    const std::lock_guard lock(mutex_);
    const auto wants = [](const auto& one) { return one->wants_predictions(); };
    return std::ranges::any_of(outputs_, wants) || std::ranges::any_of(lasting_, wants);
  }
  void learned(const LearnedSample& sample) override {
    report([&](Output& output) { output.learned(sample); });
  }
  void predicted(const PredictedSample& sample) override {
    report([&](Output& output) { output.predicted(sample); });
  }
  void health(const Health& health) override {
    report([&](Output& output) { output.health(health); });
  }
  void event(const std::string& line) override {
    report([&](Output& output) { output.event(line); });
  }

 private:
  template <typename Tell>
  void report(Tell tell_one) {
    const std::lock_guard lock(mutex_);
    for (const std::unique_ptr<Output>& output : outputs_) {
      tell_one(*output);
    }
    for (Output* const output : lasting_) {
      tell_one(*output);
    }
  }

  mutable std::mutex mutex_;
  std::vector<std::unique_ptr<Output>> outputs_;
  std::vector<Output*> lasting_;
};

}  // namespace kelpie::live
