// SPDX-License-Identifier: Apache-2.0
// The part of PathSolver that begins with a problem it doesn't know.
#include <limits>

#include "kelpie/svr/path_solver.hpp"

namespace kelpie {

// SMO gets near from afar in less time than the paths of all samples one after the other.
std::optional<SolveReport> PathSolver::restart(DualProblem& problem, const Budget& budget) {
  if (!near_) {
    near_ = smo_.restart(problem, budget).has_value();
    move_.clear();
    return std::nullopt;
  }
  if (joined_ < problem.size()) {
    if (join_free(problem, budget, kSlice)) {
      move_.set_bias(problem.kkt().bias());
    }
    return std::nullopt;
  }
  const std::size_t free = move_.free().size();
  Budget part = budget.within(slice(40 * problem.size() + free * free));
  SolveReport report = solve(problem, part);
  spent_ += report.iterations;
  if (part.exhausted() && spent_ <= bound_of_steps(problem)) {
    return std::nullopt;
  }
  if (part.exhausted()) {
    Budget unlimited;
    report = finish(problem, End::astray, unlimited, report);
  }
  near_ = false;
  joined_ = 0;
  spent_ = 0;
  return report;
}

SolveReport PathSolver::reshape(DualProblem& problem, double epsilon, double c) {
  problem.reshape(epsilon, c);
  rebuild(problem);
  Budget budget;
  return solve(problem, budget);
}

void PathSolver::rebuild(const DualProblem& problem) {
  move_.clear();
  joined_ = 0;
  join_free(problem, Budget(), std::numeric_limits<std::size_t>::max());
  joined_ = 0;
  move_.set_bias(problem.kkt().bias());
}

// From sample joined_ on; false where the budget or so much work runs out on the way.
bool PathSolver::join_free(const DualProblem& problem, Budget budget, std::size_t most) {
  std::size_t work = 0;
  for (; joined_ < problem.size(); ++joined_) {
    const bool between = problem.beta()[joined_] != 0.0 && !problem.bounded(joined_);
    if (between && !move_.free().contains(joined_)) {
      if (work >= most || !budget.spend()) {
        return false;
      }
      const std::size_t free = move_.free().size();
      const std::size_t cost = 20 * free + free * free / 8;
      work += cost;
      budget.charge(4 * cost);
      move_.join(problem, joined_, branch_at(problem, joined_, true));
    }
  }
  return true;
}

}  // namespace kelpie
