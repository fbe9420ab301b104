// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "alignment/alignment_fit.hpp"
#include "alignment/tuning.hpp"
#include "kelpie/alignment/alignment.hpp"
#include "kelpie/core/error.hpp"

namespace kelpie {
namespace {

constexpr const auto& kProfile = kAlignmentTuning.lag_profile;

// The errors over the lag of one command, all else being equal, on a grid around the best lag.
class LagProfile {
 public:
  LagProfile(AlignmentFit& fit, AlignmentGuess guess, std::size_t command)
      : fit_(fit),
        guess_(std::move(guess)),
        command_(command),
        lag_s_(guess_.actuators[command].lag_s) {
    errors_.resize(static_cast<Eigen::Index>(AlignmentFit::kFolds), 2 * kProfile.steps + 1);
    const int middle = best_step();
    for (int step = 0; step < errors_.cols(); ++step) {
      steps_.push_back(middle - kProfile.steps + step);
      errors_.col(step) = errors_at(steps_.back());
    }
  }

  // The jackknife over folds of the place of the least error.
  std::pair<double, double> interval() const {
    const Eigen::ArrayXd sum = errors_.colwise().sum();
    const auto folds = static_cast<double>(errors_.rows());
    Eigen::ArrayXd without(errors_.rows());
    for (Eigen::Index fold = 0; fold < errors_.rows(); ++fold) {
      without[fold] = place_of_least(sum - errors_.row(fold).transpose());
    }
    const double best = place_of_least(sum);
    const double error =
        std::sqrt((folds - 1.0) / folds * (without - without.mean()).square().sum());
    const double first = steps_.front();
    const double last = steps_.back();
    const bool is_flat = sum.maxCoeff() - sum.minCoeff() <= kProfile.flat * folds;
    const double low = best - kProfile.errors * error;
    const double high = best + kProfile.errors * error;
    return {is_flat || low <= first ? 0.0 : std::min(lag_at(low), lag_s_),
            is_flat || high >= last ? std::numeric_limits<double>::infinity()
                                    : std::max(lag_at(high), lag_s_)};
  }

 private:
  double lag_at(double step) const { return lag_s_ * std::pow(kProfile.factor, step); }

  Eigen::ArrayXd errors_at(int step) {
    guess_.actuators[command_].lag_s = lag_at(step);
    return fit_.log_errors(guess_).rowwise().mean();
  }

  // The lag found may be as far as the search refines from the best.
  int best_step() {
    int best = 0;
    double least = errors_at(0).mean();
    for (const int way : {1, -1}) {
      for (int step = best + way; std::abs(step) <= kProfile.steps; step += way) {
        const double error = errors_at(step).mean();
        if (error >= least) {
          break;
        }
        least = error;
        best = step;
      }
    }
    return best;
  }

  // In steps of the grid: the vertex of the parabola through the least error and its neighbours.
  double place_of_least(const Eigen::ArrayXd& curve) const {
    Eigen::Index at = 0;
    curve.minCoeff(&at);
    const double step = steps_[static_cast<std::size_t>(at)];
    if (at == 0 || at == curve.size() - 1) {
      return step;
    }
    const double bend = curve[at - 1] - 2.0 * curve[at] + curve[at + 1];
    return bend > 0.0 ? step + 0.5 * (curve[at - 1] - curve[at + 1]) / bend : step;
  }

  AlignmentFit& fit_;
  AlignmentGuess guess_;
  std::size_t command_;
  double lag_s_;
  std::vector<int> steps_;
  Eigen::ArrayXXd errors_;  // fold × step
};

}  // namespace

std::vector<LagInterval> lag_intervals(const AlignmentProblem& problem,
                                       const Alignment& alignment) {
  std::vector<LagInterval> intervals;
  if (std::ranges::all_of(alignment.actuators, [](const Actuator& a) { return a.lag_s == 0.0; })) {
    return intervals;
  }
  std::vector<std::size_t> commands;
  for (const std::string& name : alignment.commands) {
    const auto found = std::ranges::find(problem.input_names, name);
    require(found != problem.input_names.end(), name, "is no input");
    commands.push_back(static_cast<std::size_t>(found - problem.input_names.begin()));
  }
  const AlignmentRows rows(problem);
  AlignmentFit fit(rows, commands);
  AlignmentGuess guess{.shift = alignment.rows_at(problem.rate_hz), .actuators = {}};
  for (const std::size_t command : fit.commands()) {  // in the order of the inputs
    const auto place = std::ranges::find(commands, command) - commands.begin();
    guess.actuators.push_back(alignment.actuators[static_cast<std::size_t>(place)]);
  }
  for (std::size_t k = 0; k < guess.actuators.size(); ++k) {
    const double lag_s = guess.actuators[k].lag_s;
    if (lag_s > 0.0) {
      const auto [low_s, high_s] = LagProfile(fit, guess, k).interval();
      intervals.push_back({problem.input_names[fit.commands()[k]], lag_s, low_s, high_s});
    }
  }
  return intervals;
}

}  // namespace kelpie
