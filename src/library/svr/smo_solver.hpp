// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "svr/solver.hpp"

namespace kelpie {

/// Sequential minimal optimisation from the present β (a warm start): selects pairs by second-order
/// information (Fan, Chen & Lin 2005) and minimises exactly along each, until the KKT gap is within
/// tolerance. Holds no state of the problem.
class SmoSolver final : public Solver {
 public:
  /// Requires tolerance > 0, max_iterations > 0.
  SmoSolver(double tolerance, int max_iterations)
      : tolerance_(tolerance), max_iterations_(max_iterations) {}

  using Solver::solve;

  /// Ensures: kkt_gap <= tolerance or rounding, or max_iterations steps or the budget are spent.
  /// Cost O(n) per iteration. Allocates nothing. An empty problem is solved.
  SolveReport solve(DualProblem& problem, Budget& budget) override;

  /// DualProblem::hand_over(); the problem has to be solved afterwards.
  SolveReport release(DualProblem& problem, std::size_t i, Budget& budget) override;

  void removed(const DualProblem& /*problem*/, std::size_t /*i*/) override {}
  using Solver::restart;
  std::optional<SolveReport> restart(DualProblem& problem, const Budget& budget) override;
  void clear() override { spent_ = 0; }
  void visit(Archive& archive, const DualProblem& /*problem*/) override { archive.whole(spent_); }

 private:
  SolveReport descend(DualProblem& problem, Budget& budget, int spent) const;

  double tolerance_;
  int max_iterations_;
  int spent_ = 0;  ///< steps of an unfinished restart
};

}  // namespace kelpie
