// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "svr/path_move.hpp"
#include "svr/smo_solver.hpp"
#include "svr/solver.hpp"
#include "svr/tuning.hpp"

namespace kelpie {

/// Exact incremental and decremental ε-SVR by following the solution path (Cauwenberghs & Poggio
/// 2000; Ma, Theiler & Perkins 2003). The weight of a sample that violates its line of the KKT
/// table is moved until the line holds; the free samples move along and keep every satisfied line
/// satisfied. For its removal, the weight of a sample is moved to 0 in the same way. Steps lead
/// from event to event: a free weight reaches 0 or ±C, or another residual reaches the edge of the
/// tube. A step costs O(n min(|F|, n − |F|) + |F|²).
///
/// Rounding errors are monitored: every solve recomputes some residuals and renews a part of the
/// factorisation; deviations are corrected on the same paths. After too many steps of a path SMO
/// continues from the present β, and the report says so (`fell_back`). Allocates in the constructor
/// only.
class PathSolver final : public Solver {
 public:
  /// `tolerance`: the required KKT gap. Paths end near rounding; the tolerance matters for
  /// `converged` and for the fallback. Requires tolerance > 0, max_iterations > 0.
  PathSolver(std::size_t capacity, double tolerance, int max_iterations);

  using Solver::solve;

  SolveReport solve(DualProblem& problem, Budget& budget) override;
  SolveReport release(DualProblem& problem, std::size_t i, Budget& budget) override;
  void removed(const DualProblem& problem, std::size_t i) override;
  using Solver::restart;
  std::optional<SolveReport> restart(DualProblem& problem, const Budget& budget) override;
  void clear() override;
  void visit(Archive& archive, const DualProblem& problem) override {
    archive.part("move", move_, problem);
    archive.part("restart", smo_, problem);
    archive.number(slack_);
    archive.whole(next_watched_);
    archive.whole(solves_);
    archive.flag(near_);
    archive.whole(joined_, 0, problem.size());
    archive.whole(spent_);
  }

  std::size_t free_samples() const { return move_.free().size(); }

  /// Memory of a solver in bytes, beside the object itself.
  static std::size_t bytes(std::size_t capacity) { return PathMove::bytes(capacity); }

 private:
  enum class End : std::uint8_t { reached, out_of_budget, astray };

  /// The weight at the head of a path: β_c moves in the direction s = ±1 until its line holds, and
  /// at most to `limit`.
  struct Head {
    std::size_t c = 0;
    double s = 1.0;
    double limit = 0.0;
    double violation = 0.0;
  };

  /// Largest number of steps of a path; beyond this number it is astray.
  static int bound_of_steps(const DualProblem& problem) {
    return kSvr.astray_steps + kSvr.astray_steps_per_sample * static_cast<int>(problem.size());
  }
  void watch(DualProblem& problem, const Budget& budget);
  void rebuild(const DualProblem& problem);
  bool join_free(const DualProblem& problem, Budget budget, std::size_t most);
  End polish(DualProblem& problem, Budget& budget, SolveReport& report);
  End solve_rows(DualProblem& problem, Budget& budget, SolveReport& report);
  End settle(DualProblem& problem, std::size_t c, Budget& budget, SolveReport& report, int bound);
  End lead_to_zero(DualProblem& problem, std::size_t c, Budget& budget, SolveReport& report);
  End empty(DualProblem& problem, std::size_t c, Budget& budget, SolveReport& report);
  End take_step(Budget& budget, SolveReport& report, int bound) const;
  double off_edges(const DualProblem& problem) const;
  std::optional<Head> violated(const DualProblem& problem, std::size_t c) const;
  std::optional<Head> worst(const DualProblem& problem) const;
  bool step(DualProblem& problem, const Head& head);
  bool shift_bias(DualProblem& problem, const Head& head);
  SolveReport finish(DualProblem& problem, End end, Budget& budget, SolveReport report);

  double tolerance_;
  SmoSolver smo_;
  PathMove move_;
  double slack_ = 0.0;  ///< violations up to this size are rounding
  std::size_t next_watched_ = 0;
  std::uint64_t solves_ = 0;

  // State of an unfinished restart.
  bool near_ = false;       ///< the SMO part is finished
  std::size_t joined_ = 0;  ///< samples inspected since, for the free set
  int spent_ = 0;           ///< steps on paths since
};

}  // namespace kelpie
