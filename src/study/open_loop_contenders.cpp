// SPDX-License-Identifier: Apache-2.0
#include "study/open_loop_contenders.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "kelpie/online/recursive_least_squares.hpp"

namespace kelpie::study {
namespace {

// The recursive least squares an engineer would take, trained on the same rows in their order.
OpenLoop least_squares(const OpenLoop& like, const log::Dataset& data, const Split& split) {
  RecursiveLeastSquaresSettings settings;
  settings.velocities = static_cast<int>(like.states.size());
  auto axes = std::make_shared<std::vector<RecursiveLeastSquares>>();
  for (std::size_t axis = 0; axis < like.states.size(); ++axis) {
    RecursiveLeastSquares& one = axes->emplace_back(data.input_names, settings);
    for (const std::size_t row : split.training) {
      one.update(data.input(row), data.target(row)[axis], data.times_s[row]);
    }
  }
  OpenLoop loop = hold_velocity(like);
  loop.accelerations = [axes](std::span<const double> x, double, std::span<double> a) {
    for (std::size_t axis = 0; axis < axes->size(); ++axis) {
      a[axis] = (*axes)[axis].predict(x);
    }
  };
  return loop;
}

// Whether the velocities are the first inputs, as recursive least squares has them.
bool states_first(const OpenLoop& loop) {
  for (std::size_t i = 0; i < loop.states.size(); ++i) {
    if (loop.states[i] != i) {
      return false;
    }
  }
  return true;
}

// How much the states move between two rows, in widths of the ranges seen.
double liveliness(const OpenLoop& loop, const log::Dataset& data, std::size_t begin,
                  std::size_t end) {
  double sum = 0.0;
  for (const std::size_t state : loop.states) {
    double low = data.input(begin)[state];
    double high = low;
    for (std::size_t row = begin; row <= end; ++row) {
      low = std::min(low, data.input(row)[state]);
      high = std::max(high, data.input(row)[state]);
    }
    sum += (high - low) / (loop.seen[state].high - loop.seen[state].low);
  }
  return sum;
}

}  // namespace

std::vector<OpenLoopContender> open_loop_contenders(const TrainedModel& model, const OpenLoop& loop,
                                                    const log::Dataset& data, const Split& split,
                                                    double fade_s) {
  std::vector<OpenLoopContender> contenders{{"kelpie", loop}};
  if (std::isfinite(fade_s)) {
    contenders.push_back(
        {"kelpie, learned model alone", open_loop(model, std::numeric_limits<double>::infinity())});
  }
  if (states_first(loop)) {
    contenders.push_back({"recursive least squares", least_squares(loop, data, split)});
  }
  contenders.push_back({"velocity held", hold_velocity(loop)});
  return contenders;
}

void add_example(OpenLoopResult& result, const OpenLoop& loop, const log::Dataset& data,
                 std::span<const Stretch> stretches, const OpenLoopStudy& study) {
  constexpr double kEveryS = 10.0;
  double most = 0.0;
  for (const Stretch& stretch : stretches) {
    for (const std::size_t begin : starts_in(data, stretch, kEveryS)) {
      const std::size_t end = row_after(data, stretch, begin, study.horizons_s.back());
      const double lively = end < stretch.end ? liveliness(loop, data, begin, end) : 0.0;
      if (lively > most) {
        most = lively;
        result.example = roll_out(loop, data, begin, end, study.rollout);
        result.example_start_s = data.times_s[begin];
      }
    }
  }
}

}  // namespace kelpie::study
