// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "kelpie/svr/resources.hpp"
#include "svr/dual_problem.hpp"
#include "svr/tuning.hpp"

namespace kelpie {

/// The result of a solve.
struct SolveReport {
  int iterations = 0;
  double kkt_gap = 0.0;
  bool converged = false;  ///< kkt_gap <= tolerance; else iterations or budget ended
  bool fell_back = false;  ///< SMO replaced the path solver

  void visit(Archive& archive) {  ///< core/archive.hpp
    archive.whole(iterations);
    archive.number(kkt_gap);
    archive.flag(converged);
    archive.flag(fell_back);
  }
};

/// Keeps a DualProblem at its optimum while samples are added and removed. A solver may hold state
/// of the problem's samples; one problem therefore has one solver for its lifetime. Σβ = 0 and
/// |β| <= C hold after every call, whatever the result.
class Solver {
 public:
  virtual ~Solver() = default;

  /// Solves the problem from its present β, including the samples added since the last call.
  virtual SolveReport solve(DualProblem& problem, Budget& budget) = 0;

  /// Moves the weight of sample i to 0 before its removal. With an exhausted budget the move is
  /// incomplete and the call has to be repeated.
  virtual SolveReport release(DualProblem& problem, std::size_t i, Budget& budget) = 0;

  /// Has to follow problem.remove(i).
  virtual void removed(const DualProblem& problem, std::size_t i) = 0;

  /// Solves an entirely changed problem from its present β, one slice of a fraction of a
  /// millisecond per call, less under a budget. Returns a report with the last slice. Requires an
  /// otherwise unchanged problem until then.
  virtual std::optional<SolveReport> restart(DualProblem& problem, const Budget& budget) = 0;

  /// Has to follow problem.clear().
  virtual void clear() = 0;

  /// core/archive.hpp: the solver's state. Requires a loaded problem.
  virtual void visit(Archive& archive, const DualProblem& problem) = 0;

  /// solve() without a limit.
  SolveReport solve(DualProblem& problem) {
    Budget budget;
    return solve(problem, budget);
  }

  /// All slices of restart().
  SolveReport restart(DualProblem& problem) {
    std::optional<SolveReport> report;
    while (!report) {
      report = restart(problem, Budget());
    }
    return *report;
  }

 protected:
  /// Number of steps in a slice, for steps that visit `visited` numbers.
  static int slice(std::size_t visited) {
    return 1 + static_cast<int>(kSvr.work_slice / (visited + 100));
  }

  Solver() = default;
  Solver(const Solver&) = default;
  Solver& operator=(const Solver&) = default;
};

}  // namespace kelpie
