// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/alignment_search.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "kelpie/core/setting.hpp"
#include "kelpie/model/alignment_rows.hpp"
#include "kelpie/motion/states.hpp"
#include "model/shifted_fit.hpp"

namespace kelpie {
namespace {

constexpr double kFarthestS = 1.0;
constexpr double kMostRowsAway = 1e6;
constexpr int kStepsPerSide = 10;
constexpr std::size_t kRowsPerCoefficient = 10;
constexpr double kLeastGain = 0.03;    // mean of logarithms
constexpr double kGainingShare = 0.6;  // of folds and targets that gain
constexpr double kSlopeCorrelation = 0.5;

double correlation_between(const Eigen::ArrayXd& a, const Eigen::ArrayXd& b) {
  const Eigen::ArrayXd da = a - a.mean();
  const Eigen::ArrayXd db = b - b.mean();
  const double both = std::sqrt(da.square().sum() * db.square().sum());
  return both > 0.0 ? (da * db).sum() / both : 0.0;
}

// For each target the input whose slope over half a second goes with it best. None unless every
// target has one of its own.
std::vector<std::size_t> accelerated_inputs(const AlignmentProblem& problem,
                                            const AlignmentRows& rows) {
  const int reach = std::max(1, static_cast<int>(std::lround(0.25 * problem.rate_hz)));
  const auto size = static_cast<Eigen::Index>(rows.size());
  std::vector<std::size_t> best(rows.targets.size());
  std::vector<double> most(rows.targets.size(), kSlopeCorrelation);
  Eigen::ArrayXd rise(size);
  for (std::size_t i = 0; i < rows.inputs.size(); ++i) {
    for (Eigen::Index at = 0; at < size; ++at) {
      const auto row = static_cast<std::size_t>(at);
      rise[at] =
          rows.inputs[i][rows.shifted(row, reach)] - rows.inputs[i][rows.shifted(row, -reach)];
    }
    for (std::size_t target = 0; target < best.size(); ++target) {
      const double found = correlation_between(
          rise, Eigen::Map<const Eigen::ArrayXd>(rows.targets[target].data(), size));
      if (found > most[target]) {
        most[target] = found;
        best[target] = i;
      }
    }
  }
  std::ranges::sort(best);
  const bool all = std::ranges::none_of(most, [](double c) { return c == kSlopeCorrelation; }) &&
                   std::ranges::adjacent_find(best) == best.end();
  return all ? best : std::vector<std::size_t>{};
}

// All inputs but the velocities; none where there are none of these.
std::vector<std::size_t> all_but(std::span<const std::size_t> velocities, std::size_t inputs) {
  std::vector<std::size_t> commands;
  for (std::size_t i = 0; i < inputs && !velocities.empty(); ++i) {
    if (std::ranges::find(velocities, i) == velocities.end()) {
      commands.push_back(i);
    }
  }
  return commands;
}

std::vector<std::size_t> velocities_by_name(std::span<const std::string> inputs,
                                            std::size_t targets, const std::string& states) {
  std::vector<std::size_t> velocities = find_states(states, inputs, targets);
  if (velocities.empty()) {
    velocities.resize(named_velocities(inputs));
    std::iota(velocities.begin(), velocities.end(), std::size_t{0});
  }
  return velocities;
}

std::vector<std::size_t> commands_of(const AlignmentProblem& problem, const AlignmentRows& rows) {
  std::vector<std::size_t> velocities =
      velocities_by_name(problem.input_names, problem.target_count, problem.states);
  if (velocities.empty()) {
    velocities = accelerated_inputs(problem, rows);
  }
  return all_but(velocities, problem.input_names.size());
}

std::string percent(double share) {
  return number_text(std::round(1000.0 * share) / 10.0) + " %";
}

// Fills in the shift that explains most, or why it is the one in use.
void search_shift(const AlignmentFit& fit, const AlignmentProblem& problem, AlignmentFound& found) {
  const int farthest = static_cast<int>(std::min(kFarthestS * problem.rate_hz, kMostRowsAway));
  const int step = std::max(1, (farthest + kStepsPerSide - 1) / kStepsPerSide);
  const int in_use = problem.current_rows;
  const Eigen::ArrayXXd as_it_is = fit.log_errors(in_use);
  int best = in_use;
  double most = 0.0;
  double share = 0.0;
  const auto compare = [&](int shift) {
    const Eigen::ArrayXXd gains = as_it_is - fit.log_errors(shift);
    if (gains.mean() > most) {
      best = shift;
      most = gains.mean();
      share = (gains > 0.0).cast<double>().mean();
    }
  };
  if (in_use != 0) {
    compare(0);
  }
  for (int shift = step; shift <= farthest; shift += step) {
    compare(shift);
    compare(-shift);
  }
  found.gain = 1.0 - std::exp(-most);
  const std::string evidence = percent(found.gain) + " of what is unexplained " +
                               (in_use == 0 ? "without" : "with the one before") + ", on " +
                               std::to_string(AlignmentFit::kFolds) + " folds of the training rows";
  const bool clear = most >= kLeastGain && share >= kGainingShare;
  // Where least squares describe the vehicle badly they may like commands that merely go with it.
  if (clear && fit.log_kernel_error(best) < fit.log_kernel_error(in_use)) {
    found.alignment.rows = best;
    found.alignment.lag_s = best / problem.rate_hz;
    found.why = "this explains " + evidence;
  } else if (best == in_use) {
    found.why = "no shift explains more";
  } else {
    found.why = "no shift is clearly better; the best explains " + evidence;
    found.gain = 0.0;
  }
}

}  // namespace

std::vector<std::size_t> named_commands(std::span<const std::string> inputs, std::size_t targets,
                                        const std::string& states) {
  return all_but(velocities_by_name(inputs, targets, states), inputs.size());
}

std::vector<std::size_t> find_commands(const AlignmentProblem& problem) {
  return commands_of(problem, AlignmentRows(problem));
}

AlignmentFound find_alignment(const AlignmentProblem& problem) {
  AlignmentFound found;
  found.alignment.rows = problem.current_rows;
  found.alignment.lag_s = problem.current_rows / problem.rate_hz;
  const AlignmentRows rows(problem);
  const std::vector<std::size_t> commands = commands_of(problem, rows);
  for (const std::size_t command : commands) {
    found.alignment.commands.push_back(problem.input_names[command]);
  }
  if (commands.empty()) {
    found.why = "no inputs are known to be velocities and others commands";
    return found;
  }
  const AlignmentFit fit(rows, commands);
  const std::size_t needed = kRowsPerCoefficient * fit.terms();
  if (rows.size() < needed) {
    found.why = std::to_string(rows.size()) + " training rows are too few to tell a shift; " +
                std::to_string(needed) + " are needed";
  } else if (problem.rate_hz * kFarthestS < 1.0) {
    found.why = "rows are too far apart in time to tell a shift";
  } else {
    search_shift(fit, problem, found);
  }
  return found;
}

}  // namespace kelpie
