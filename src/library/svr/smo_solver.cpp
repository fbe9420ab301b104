// SPDX-License-Identifier: Apache-2.0
#include "svr/smo_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include "svr/tuning.hpp"

namespace kelpie {
namespace {

// The j that lets the objective fall most, were the step along (i, j) not bounded: the largest
// violation² / curvature.
std::size_t best_partner(const DualProblem& problem, const Kkt& kkt) {
  const std::size_t i = kkt.most_upward;
  std::size_t best = i;
  double best_gain = -1.0;
  for (std::size_t j = 0; j < problem.size(); ++j) {
    const double violation = kkt.lower - problem.upper_bound(j);
    if (violation > 0.0) {
      const double gain = violation * violation / curvature(problem.kernel(), i, j);
      if (gain > best_gain) {
        best_gain = gain;
        best = j;
      }
    }
  }
  return best;
}

// A residual is a sum over the samples: gaps below this are rounding.
double rounding_of(const DualProblem& problem) {
  constexpr double kOfASum = 4.0 * std::numeric_limits<double>::epsilon();
  double weights = 0.0;
  double largest = 0.0;
  for (std::size_t i = 0; i < problem.size(); ++i) {
    weights += std::abs(problem.beta()[i]) * problem.kernel().diagonal()[i];
    largest = std::max(largest, std::abs(problem.targets()[i]));
  }
  return kOfASum * (weights + largest);
}

}  // namespace

SolveReport SmoSolver::solve(DualProblem& problem, Budget& budget) {
  return descend(problem, budget, 0);
}

std::optional<SolveReport> SmoSolver::restart(DualProblem& problem, const Budget& budget) {
  Budget part = budget.within(slice(kSvr.work_smo_step * problem.size()));
  const SolveReport report = descend(problem, part, spent_);
  spent_ = part.exhausted() ? report.iterations : 0;
  return part.exhausted() ? std::nullopt : std::optional(report);
}

// `spent`: steps of this solve before this call.
SolveReport SmoSolver::descend(DualProblem& problem, Budget& budget, int spent) const {
  SolveReport report{.iterations = spent};
  while (true) {
    const Kkt kkt = problem.kkt();
    report.kkt_gap = kkt.gap();
    report.converged = report.kkt_gap <= tolerance_ || (report.kkt_gap < kSvr.maybe_rounding &&
                                                        report.kkt_gap <= rounding_of(problem));
    if (report.converged || report.iterations == max_iterations_ ||
        !budget.spend(kSvr.work_smo_step * problem.size())) {
      return report;
    }
    problem.descend(kkt.most_upward, best_partner(problem, kkt));
    ++report.iterations;
  }
}

SolveReport SmoSolver::release(DualProblem& problem, std::size_t i, Budget& /*budget*/) {
  problem.hand_over(i);
  const double gap = problem.kkt().gap();
  return {.kkt_gap = gap, .converged = gap <= tolerance_};
}

}  // namespace kelpie
