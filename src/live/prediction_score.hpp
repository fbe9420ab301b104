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
#include "live/recent.hpp"

namespace kelpie::live {

/// How well what was said of the last samples held, beside what simple predictors said of the same
/// (study/baselines.hpp), and how long rows took. Begins anew with every start of the program.
class PredictionScore {
 public:
  static constexpr std::size_t kScored = 600;   ///< samples: a minute of 10 Hz
  static constexpr std::size_t kDelays = 1000;  ///< rows

  explicit PredictionScore(const StreamPlan& plan);

  /// A sample that has just been learned, and what the model had said of it.
  void score(std::span<const double> x, std::span<const double> y, double t,
             std::span<const Decision> decisions);
  void add_delay(std::chrono::nanoseconds delay);  ///< Of one row.

  /// Fills in axes, thrusters and delays.
  void report(const DynamicsModel& model, LearnerHealth& health) const;

 private:
  // What was said of a sample before it was learned, and what it was.
  struct Scored {
    double truth = 0.0;
    double predicted = 0.0;
    bool is_inside = false;          // the interval
    std::array<double, 3> simple{};  // what simple predictors said; NaN: nothing
  };

  std::vector<std::string> inputs_;
  std::vector<std::string> names_;                      // of the targets
  std::array<std::unique_ptr<OnlineModel>, 3> simple_;  // null: there is none
  std::vector<Recent<Scored>> scored_;                  // per axis
  Recent<double> delays_ms_;
};

}  // namespace kelpie::live
