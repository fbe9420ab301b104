// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/stream/stream_plan.hpp"
#include "live/health.hpp"

namespace kelpie::live {

/// The last values of a quantity, at most `capacity`.
template <typename T>
class Recent {
 public:
  explicit Recent(std::size_t capacity) : capacity_(capacity) { values_.reserve(capacity); }

  void add(const T& value) {
    if (values_.size() < capacity_) {
      values_.push_back(value);
    } else {
      values_[next_] = value;
      next_ = (next_ + 1) % capacity_;
    }
  }
  const std::vector<T>& values() const { return values_; }  ///< Unordered.

 private:
  std::size_t capacity_;
  std::vector<T> values_;
  std::size_t next_ = 0;
};

/// Scores of the last predictions, beside those of simple predictors on the same samples
/// (study/baselines.hpp), and delays of the last rows. Every start of the program begins anew.
class PredictionScore {
 public:
  explicit PredictionScore(const StreamPlan& plan);

  /// Adds a sample just learned, and the model's decisions about the sample.
  void score(std::span<const double> x, std::span<const double> y, double t,
             std::span<const Decision> decisions);
  void add_delay(std::chrono::nanoseconds delay);  ///< Of one row.

  /// Fills in axes, thrusters and delays.
  void report(const DynamicsModel& model, LearnerHealth& health) const;

 private:
  struct Scored {
    double truth = 0.0;
    double predicted = 0.0;
    bool is_inside = false;          // the interval
    std::array<double, 3> simple{};  // simple predictors; NaN: no prediction
  };

  std::vector<std::string> inputs_;
  std::vector<std::string> names_;                      // of the targets
  std::array<std::unique_ptr<OnlineModel>, 3> simple_;  // null: not available
  std::vector<Recent<Scored>> scored_;                  // per axis
  Recent<double> delays_ms_;
};

}  // namespace kelpie::live
