// SPDX-License-Identifier: Apache-2.0
#include "study/yardsticks.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <vector>

#include "kelpie/core/error.hpp"
#include "kelpie/online/recursive_least_squares.hpp"
#include "kelpie/physics/states.hpp"
#include "study/metrics.hpp"
#include "study/result.hpp"

namespace kelpie::study {
namespace {

constexpr double kHuber = 3.0;
constexpr std::size_t kMostVelocities = 6;

class Mean final : public OnlineRegressor {
 public:
  Decision update(std::span<const double> /*x*/, double y, double /*t*/) override {
    mean_ += (y - mean_) / static_cast<double>(++count_);
    return {};
  }
  double predict(std::span<const double> /*x*/) const override { return mean_; }
  Status status() const override { return {}; }

 private:
  double mean_ = 0.0;
  std::size_t count_ = 0;
};

class LastValue final : public OnlineRegressor {
 public:
  Decision update(std::span<const double> /*x*/, double y, double /*t*/) override {
    last_ = y;
    return {};
  }
  double predict(std::span<const double> /*x*/) const override { return last_; }
  Status status() const override { return {}; }

 private:
  double last_ = 0.0;
};

// Null where the terms of these inputs are too many.
std::unique_ptr<OnlineRegressor> least_squares(const log::Dataset& data) {
  const std::size_t named = named_velocities(data.input_names);
  const std::size_t velocities =
      named > 0 ? named : std::min(data.target_names.size(), data.input_names.size());
  RecursiveLeastSquaresSettings settings;
  settings.velocities = static_cast<int>(std::min(velocities, kMostVelocities));
  settings.huber = kHuber;
  try {
    return std::make_unique<RecursiveLeastSquares>(data.input_names, settings);
  } catch (const InputError&) {
    return nullptr;
  }
}

// Shows the rows one by one and judges what was predicted.
Yardstick measure(OnlineRegressor& predictor, const log::Dataset& data, const Split& split,
                  const YardstickRun& run) {
  std::vector<double> truth;
  std::vector<double> predicted;
  const auto judge = [&](std::size_t row) {
    truth.push_back(data.target(row)[run.axis]);
    predicted.push_back(predictor.predict(data.input(row)));
  };
  auto next = run.samples.begin();
  for (std::size_t i = 0; i < run.shown; ++i) {
    const std::size_t row = split.training[i];
    if (next != run.samples.end() && *next == i + 1) {
      judge(row);
      ++next;
    }
    predictor.update(data.input(row), data.target(row)[run.axis], data.times_s[row]);
  }
  Yardstick yardstick;
  yardstick.prequential_r2 = r_squared(truth, predicted);
  truth.clear();
  predicted.clear();
  for (const std::size_t row : run.held_out) {
    judge(row);
  }
  yardstick.r2_final = r_squared(truth, predicted);
  return yardstick;
}

}  // namespace

Yardsticks yardsticks_of(const log::Dataset& data, const Split& split, const YardstickRun& run) {
  Yardsticks yardsticks;
  if (const std::unique_ptr<OnlineRegressor> fit = least_squares(data)) {
    yardsticks.least_squares = measure(*fit, data, split, run);
  }
  Mean mean;
  yardsticks.mean = measure(mean, data, split, run);
  LastValue last;
  yardsticks.last_value.prequential_r2 = measure(last, data, split, run).prequential_r2;
  return yardsticks;
}

void add_yardsticks(const log::Dataset& data, const Split& split, StreamResult& result) {
  for (std::size_t i = 0; i < result.axes.size(); ++i) {
    AxisResult& axis = result.axes[i];
    std::vector<std::size_t> held_out;
    std::ranges::copy_if(split.held_out, std::back_inserter(held_out), [&](std::size_t row) {
      return !axis.stages.empty() && data.configurations[row] == axis.stages.back().configuration;
    });
    axis.yardsticks =
        yardsticks_of(data, split, {i, result.samples_shown, axis.one_step.samples, held_out});
  }
}

}  // namespace kelpie::study
