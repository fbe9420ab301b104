// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "kelpie/svr/dual_problem.hpp"

namespace kelpie {

/// How a solve ended.
struct SolveReport {
  int iterations = 0;
  double kkt_gap = 0.0;
  bool converged = false;  ///< kkt_gap <= tolerance; else the iteration bound was reached
};

/// Sequential minimal optimisation from whatever β the problem has (a warm start): pairs chosen by
/// second-order information (Fan, Chen & Lin 2005), exact minimisation along each, until the KKT
/// gap is within tolerance.
class SmoSolver {
 public:
  /// Requires tolerance > 0, max_iterations > 0.
  SmoSolver(double tolerance, int max_iterations)
      : tolerance_(tolerance), max_iterations_(max_iterations) {}

  /// Ensures: kkt_gap <= tolerance, or exactly max_iterations steps were made; Σβ = 0 and
  /// |β| <= C in either case. Cost O(n) per iteration. Allocates nothing. An empty problem is
  /// solved.
  SolveReport solve(DualProblem& problem) const;

 private:
  double tolerance_;
  int max_iterations_;
};

}  // namespace kelpie
