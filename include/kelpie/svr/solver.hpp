// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "kelpie/svr/budget.hpp"
#include "kelpie/svr/dual_problem.hpp"
#include "svr/tuning.hpp"

namespace kelpie {

/// How a solve ended.
struct SolveReport {
  int iterations = 0;
  double kkt_gap = 0.0;
  bool converged = false;  ///< kkt_gap <= tolerance; else a bound or the budget was reached
  bool fell_back = false;  ///< the solver asked for gave up, and another one took over

  void visit(Archive& archive) {  ///< core/archive.hpp
    archive.whole(iterations);
    archive.number(kkt_gap);
    archive.flag(converged);
    archive.flag(fell_back);
  }
};

/// Keeps one DualProblem at its optimum while samples come and go. A solver may keep state about
/// the problem's samples, so all changes of one problem go past the same solver. Σβ = 0 and
/// |β| <= C hold after every call, whatever its outcome.
class Solver {
 public:
  virtual ~Solver() = default;

  /// Brings the problem to its optimum from whatever β it has. Samples added since the last call
  /// need no announcement.
  virtual SolveReport solve(DualProblem& problem, Budget& budget) = 0;

  /// Takes the weight of sample i to 0, so that it can be removed. When the budget runs out, the
  /// weight is on its way, and the call is to be repeated.
  virtual SolveReport release(DualProblem& problem, std::size_t i, Budget& budget) = 0;

  /// Tells that problem.remove(i) has been done.
  virtual void removed(const DualProblem& problem, std::size_t i) = 0;

  /// Solves a problem that has become another altogether, from the β it has: a slice of that work
  /// with every call, a fraction of a millisecond, or less where the budget runs out. Nothing
  /// before the last one; until then nobody else changes the problem.
  virtual std::optional<SolveReport> restart(DualProblem& problem, const Budget& budget) = 0;

  /// Tells that problem.clear() has been done.
  virtual void clear() = 0;

  /// core/archive.hpp; what is kept about the problem, which is loaded already.
  virtual void visit(Archive& archive, const DualProblem& problem) = 0;

  /// The same without a limit.
  SolveReport solve(DualProblem& problem) {
    Budget budget;
    return solve(problem, budget);
  }

  /// All of restart() at once.
  SolveReport restart(DualProblem& problem) {
    std::optional<SolveReport> report;
    while (!report) {
      report = restart(problem, Budget());
    }
    return *report;
  }

 protected:
  /// Steps that fit into a slice, with so many numbers in each.
  static int slice(std::size_t visited) {
    return 1 + static_cast<int>(kSvr.work_slice / (visited + 100));
  }

  Solver() = default;
  Solver(const Solver&) = default;
  Solver(Solver&&) = default;
  Solver& operator=(const Solver&) = default;
  Solver& operator=(Solver&&) = default;
};

}  // namespace kelpie
