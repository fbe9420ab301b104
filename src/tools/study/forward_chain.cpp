// SPDX-License-Identifier: Apache-2.0
#include "study/forward_chain.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "kelpie/core/error.hpp"
#include "kelpie/core/scaling.hpp"
#include "study/tuning.hpp"

namespace kelpie::study {
namespace {

constexpr std::size_t kStretches = kTuning.chain.stretches;
constexpr std::size_t kWindows = kTuning.chain.windows;

Rung make_rung(std::size_t rows, std::size_t windows, std::size_t length, std::size_t warm) {
  Rung rung;
  for (std::size_t i = 0; i < windows; ++i) {
    const std::size_t begin = windows == 1 ? 0 : i * (rows - length) / (windows - 1);
    const std::size_t learned = std::max(warm, length / (kStretches + 1));
    rung.windows.push_back({begin, begin + learned, begin + length});
    rung.rows += length;
  }
  return rung;
}

std::vector<Rung> make_rungs(const log::Dataset& data, std::size_t rows, std::size_t warmup) {
  const std::size_t warm = warmup + warmup / 4;
  // At least as much to judge on as was learned before, and a few rows in each stretch.
  const std::size_t least = warm + std::max(warm, 2 * kStretches);
  if (rows < least) {
    throw InputError({.file = data.source, .line = 0, .field = "warmup"},
                     std::to_string(warmup) + " samples need " + std::to_string(least) +
                         " or more training rows to be tuned on; there are " +
                         std::to_string(rows));
  }
  std::vector<Rung> rungs;
  std::size_t longest = 0;
  for (const std::size_t part : kTuning.chain.parts) {
    const std::size_t length = std::max(rows / part, least);
    if (kWindows * length < rows && length > longest) {
      rungs.push_back(make_rung(rows, kWindows, length, warm));
      longest = length;
    }
  }
  rungs.push_back(make_rung(rows, 1, rows, warm));
  return rungs;
}

}  // namespace

// One learner on its way through one rung.
class ForwardChain::Pass {
 public:
  Pass(const ForwardChain& chain, std::size_t axis, double most_iterations, const Watcher& watch)
      : chain_(chain), axis_(axis), most_iterations_(most_iterations), watch_(watch) {}

  // Whether the pass may go on.
  bool through(const Window& window, OnlineRegressor& learner) {
    bool going = learn(window.begin, window.judged_from, learner);
    std::size_t begin = window.judged_from;
    for (std::size_t i = 1; going && i <= kStretches; ++i) {
      const std::size_t end =
          window.judged_from + i * (window.end - window.judged_from) / kStretches;
      judge(begin, end, learner);
      // Nobody is judged after the last stretch, so learning it would tell nothing.
      going = i == kStretches || learn(begin, end, learner);
      begin = end;
    }
    return going;
  }

  ChainScore finish(double rows) {
    score_.iterations_per_row = iterations_ / rows;
    if (!score_.given_up && !score_.stopped) {
      const auto count = static_cast<double>(score_.stretches.size());
      score_.score = std::accumulate(score_.stretches.begin(), score_.stretches.end(), 0.0) / count;
    }
    return std::move(score_);
  }

 private:
  double target(std::size_t row) const { return chain_.data_.target(row)[axis_]; }

  bool learn(std::size_t begin, std::size_t end, OnlineRegressor& learner) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t row = chain_.rows_[i];
      const Decision decision =
          learner.update(chain_.data_.input(row), target(row), chain_.data_.times_s[row]);
      iterations_ += decision.iterations;
      score_.given_up = iterations_ > most_iterations_;
      const bool look = ++unwatched_ == kTuning.chain.rows_between_watches;
      score_.stopped = look && !watch_(std::exchange(unwatched_, 0));
      if (score_.given_up || score_.stopped) {
        return false;
      }
    }
    return true;
  }

  void judge(std::size_t begin, std::size_t end, const OnlineRegressor& learner) {
    double squares = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t row = chain_.rows_[i];
      const double error = learner.predict(chain_.data_.input(row)) - target(row);
      squares += error * error;
    }
    score_.stretches.push_back(1.0 - squares / static_cast<double>(end - begin) /
                                         chain_.variance_[axis_]);
  }

  const ForwardChain& chain_;
  std::size_t axis_;
  double most_iterations_;
  const Watcher& watch_;
  double iterations_ = 0.0;
  std::size_t unwatched_ = 0;
  ChainScore score_;
};

ForwardChain::ForwardChain(const log::Dataset& data, std::vector<std::size_t> rows,
                           std::size_t warmup)
    : data_(data), rows_(std::move(rows)), rungs_(make_rungs(data, rows_.size(), warmup)) {
  for (std::size_t axis = 0; axis < data.target_names.size(); ++axis) {
    Moments moments(1);
    for (const std::size_t row : rows_) {
      moments.add(data.target(row).subspan(axis, 1));
    }
    variance_.push_back(moments.covariance()(0, 0));
    if (!(variance_.back() > 0.0)) {
      throw InputError({.file = data.source, .line = 0, .field = data.target_names[axis]},
                       "is constant in the training rows; there is nothing to tune");
    }
  }
}

ChainScore ForwardChain::score(std::size_t rung, std::size_t axis, const LearnerFactory& make,
                               double most_iterations, const Watcher& watch) const {
  const auto rows = static_cast<double>(rungs_[rung].rows);
  Pass pass(*this, axis, most_iterations * rows, watch);
  for (const Window& window : rungs_[rung].windows) {
    const std::unique_ptr<OnlineRegressor> learner = make();
    if (!pass.through(window, *learner)) {
      break;
    }
  }
  return pass.finish(rows);
}

}  // namespace kelpie::study
