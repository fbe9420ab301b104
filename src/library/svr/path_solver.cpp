// SPDX-License-Identifier: Apache-2.0
#include "svr/path_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include "svr/tuning.hpp"

namespace kelpie {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

// Where samples are millions of deviations apart the factor of their kernel matrix can overflow.
bool is_finite(const DualProblem& problem) {
  return std::ranges::all_of(problem.beta(), [](double beta) { return std::isfinite(beta); });
}

// Work of a path among n samples, without its moves.
std::size_t path_work(const FreeSet& free, std::size_t n) {
  return free.size() * (free.size() + n) + kSvr.work_aside;
}

// Work of PathMove::leave(); half the work of renew_oldest() and of correction().
std::size_t factor_work(const FreeSet& free) {
  return free.size() * free.size();
}

}  // namespace

PathSolver::PathSolver(std::size_t capacity, double tolerance, int max_iterations)
    : tolerance_(tolerance), smo_(tolerance, max_iterations), move_(capacity) {}

SolveReport PathSolver::solve(DualProblem& problem, Budget& budget) {
  SolveReport report;
  watch(problem, budget);
  End end = polish(problem, budget, report);
  if (end == End::reached) {
    end = solve_rows(problem, budget, report);
  }
  return finish(problem, end, budget, report);
}

SolveReport PathSolver::release(DualProblem& problem, std::size_t i, Budget& budget) {
  SolveReport report;
  End end = End::reached;
  if (problem.beta()[i] != 0.0) {
    end = lead_to_zero(problem, i, budget, report);
  }
  if (end == End::astray) {
    problem.hand_over(i);
  }
  report.kkt_gap = problem.kkt().gap();
  report.converged = end == End::reached;
  return report;
}

void PathSolver::removed(const DualProblem& problem, std::size_t i) {
  move_.renumber(problem.size(), i);
}

void PathSolver::clear() {
  move_.clear();
  slack_ = 0.0;
  next_watched_ = 0;
  solves_ = 0;
  smo_.clear();
  near_ = false;
  joined_ = 0;
  spent_ = 0;
}

// Rounding errors of thousands of steps are noticed before they matter, a few samples at a time.
void PathSolver::watch(DualProblem& problem, const Budget& budget) {
  const std::size_t n = problem.size();
  double largest = 0.0;
  double weights = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    largest = std::max(largest, std::abs(problem.targets()[i]));
    weights += std::abs(problem.beta()[i]);
  }
  slack_ =
      kSvr.slack_of_targets * (largest + problem.loss().epsilon) + kSvr.slack_of_weights * weights;
  double drift = 0.0;
  for (std::size_t k = 0; k < std::min(kSvr.renewed_residuals, n); ++k) {
    next_watched_ = next_watched_ + 1 < n ? next_watched_ + 1 : 0;
    drift = std::max(drift, renew(problem, next_watched_));
  }
  for (std::size_t i = 0; drift > slack_ && i < n; ++i) {
    renew(problem, i);
  }
  const FreeSet& free = move_.free();
  if (free.size() == 0) {
    const Kkt kkt = problem.kkt();
    if (kkt.gap() == 0.0) {
      move_.set_bias(kkt.bias());
    }
    return;
  }
  if (++solves_ % kSvr.factor_renewal == 0) {
    budget.charge(2 * factor_work(move_.free()));
    move_.renew_oldest(problem);
  }
  double off = 0.0;
  for (std::size_t k = 0; k < free.size(); ++k) {
    off += off_edge(problem, move_, k);
  }
  move_.set_bias(move_.bias() + off / static_cast<double>(free.size()));
}

PathSolver::End PathSolver::polish(DualProblem& problem, Budget& budget, SolveReport& report) {
  const int bound = report.iterations + bound_of_steps(problem);
  for (int whole_steps = 0; whole_steps < kSvr.polish_rounds && off_edges(problem) > slack_;) {
    if (const End end = take_step(budget, report, bound); end != End::reached) {
      return end;
    }
    budget.charge(2 * factor_work(move_.free()));
    move_.begin(problem, PathMove::kNone, slack_);
    move_.correction(problem);
    const PathEvent event = move_.first_event(problem, 1.0);
    move_.apply(problem, event);
    move_.end(problem);
    whole_steps += event.kind == PathEvent::Kind::none ? 1 : 0;
  }
  return End::reached;
}

double PathSolver::off_edges(const DualProblem& problem) const {
  double off = 0.0;
  for (std::size_t k = 0; k < move_.free().size(); ++k) {
    off = std::max(off, std::abs(off_edge(problem, move_, k)));
  }
  return off;
}

PathSolver::End PathSolver::take_step(Budget& budget, SolveReport& report, int bound) const {
  if (!budget.spend(move_.move_work())) {
    return End::out_of_budget;
  }
  return ++report.iterations > bound ? End::astray : End::reached;
}

PathSolver::End PathSolver::solve_rows(DualProblem& problem, Budget& budget, SolveReport& report) {
  const int bound = report.iterations + bound_of_steps(problem);
  End end = End::reached;
  while (end == End::reached) {
    const std::optional<Head> head = worst(problem);
    if (!head) {
      break;
    }
    if (!budget.goes_on()) {
      return End::out_of_budget;
    }
    budget.charge(path_work(move_.free(), problem.size()));
    move_.begin(problem, head->c, slack_);
    end = settle(problem, head->c, budget, report, bound);
    move_.end(problem);
  }
  return end;
}

PathSolver::End PathSolver::settle(DualProblem& problem, std::size_t c, Budget& budget,
                                   SolveReport& report, int bound) {
  while (const std::optional<Head> found = violated(problem, c)) {
    const Head& head = *found;
    if (const End end = take_step(budget, report, bound); end != End::reached) {
      return end;
    }
    if (move_.free().size() == 0) {
      shift_bias(problem, head);
    } else if (step(problem, head)) {
      return End::reached;
    }
  }
  // A weight between its ends belongs to a free sample, also where its line held by chance.
  if (problem.beta()[c] != 0.0 && !at_bound(problem, c)) {
    move_.join(problem, c, branch_at(problem, c, true));
  }
  return End::reached;
}

PathSolver::End PathSolver::lead_to_zero(DualProblem& problem, std::size_t c, Budget& budget,
                                         SolveReport& report) {
  if (!budget.goes_on()) {
    return End::out_of_budget;
  }
  budget.charge(path_work(move_.free(), problem.size()));
  if (move_.free().contains(c)) {
    budget.charge(factor_work(move_.free()));
    move_.leave(problem, c);
  }
  move_.begin(problem, c, slack_);
  const End end = empty(problem, c, budget, report);
  move_.end(problem);
  return end;
}

PathSolver::End PathSolver::empty(DualProblem& problem, std::size_t c, Budget& budget,
                                  SolveReport& report) {
  const int bound = report.iterations + bound_of_steps(problem);
  while (problem.beta()[c] != 0.0) {
    if (const End end = take_step(budget, report, bound); end != End::reached) {
      return end;
    }
    const Head head{
        .c = c, .s = problem.beta()[c] < 0.0 ? 1.0 : -1.0, .limit = 0.0, .violation = kUnbounded};
    if (move_.free().size() > 0) {
      step(problem, head);
    } else if (!shift_bias(problem, head)) {
      problem.set_beta(c, 0.0);  // no other sample can take it over: rounding
    }
  }
  return End::reached;
}

std::optional<PathSolver::Head> PathSolver::violated(const DualProblem& problem,
                                                     std::size_t c) const {
  const double beta = problem.beta()[c];
  const double bound = problem.loss().c;
  const bool one_line = problem.loss().epsilon == 0.0;
  if (const double above = problem.lower_bound(c) - move_.bias(); above > slack_) {
    return Head{
        .c = c, .s = 1.0, .limit = beta < 0.0 && !one_line ? 0.0 : bound, .violation = above};
  }
  if (const double below = move_.bias() - problem.upper_bound(c); below > slack_) {
    return Head{
        .c = c, .s = -1.0, .limit = beta > 0.0 && !one_line ? 0.0 : -bound, .violation = below};
  }
  return std::nullopt;
}

std::optional<PathSolver::Head> PathSolver::worst(const DualProblem& problem) const {
  std::optional<Head> worst;
  for (std::size_t j = 0; j < problem.size(); ++j) {
    if (!move_.free().contains(j)) {
      const std::optional<Head> head = violated(problem, j);
      if (head && (!worst || head->violation > worst->violation)) {
        worst = head;
      }
    }
  }
  return worst;
}

// One straight move. True when c's line holds at its end, c being free now.
bool PathSolver::step(DualProblem& problem, const Head& head) {
  const double closing = -head.s * move_.head(problem, head.s);
  const double to_limit = std::abs(head.limit - problem.beta()[head.c]);
  const double to_line = closing > 0.0 ? head.violation / closing : kUnbounded;
  const PathEvent event = move_.first_event(problem, std::min(to_limit, to_line));
  move_.apply(problem, event);
  if (event.kind != PathEvent::Kind::none) {
    return false;
  }
  if (!(to_line < to_limit)) {  // also where overflow made one NaN
    problem.set_beta(head.c, head.limit);
    return false;
  }
  move_.join(problem, head.c, branch_at(problem, head.c, head.s > 0.0));
  return true;
}

// With no free sample b is not unique: it moves to where c's line holds, or another sample's weight
// may begin to move the other way and so make room for c's. False when neither can be.
bool PathSolver::shift_bias(DualProblem& problem, const Head& head) {
  move_.refresh(problem);
  const bool grows = head.s > 0.0;
  const double bias = move_.bias();
  double nearest = bias + head.s * head.violation;
  std::size_t partner = PathMove::kNone;
  for (std::size_t j = 0; j < problem.size(); ++j) {
    const double edge = grows ? problem.upper_bound(j) : problem.lower_bound(j);
    const bool holds = grows ? edge >= bias - slack_ : edge <= bias + slack_;
    if (j != head.c && holds && (grows ? edge < nearest : edge > nearest)) {
      nearest = edge;
      partner = j;
    }
  }
  if (!std::isfinite(nearest)) {
    return false;
  }
  move_.set_bias(nearest);
  if (partner != PathMove::kNone) {
    move_.join(problem, partner, branch_at(problem, partner, !grows));
  }
  return true;
}

SolveReport PathSolver::finish(DualProblem& problem, End end, Budget& budget, SolveReport report) {
  report.kkt_gap = problem.kkt().gap();
  const bool overflowed = !is_finite(problem);
  report.converged = end != End::out_of_budget && !overflowed && report.kkt_gap <= tolerance_;
  if (end == End::astray || overflowed || (end == End::reached && !report.converged)) {
    for (std::size_t i = 0; overflowed && i < problem.size(); ++i) {
      problem.set_beta(i, 0.0);
    }
    for (std::size_t i = 0; i < problem.size(); ++i) {
      renew(problem, i);
    }
    SolveReport second = smo_.solve(problem, budget);
    rebuild(problem);
    second.iterations += report.iterations;
    second.fell_back = true;
    return second;
  }
  return report;
}

// A changed problem is far from its optimum, where SMO is faster than a path per sample. Three
// stages, each in slices: SMO to the tolerance; the factor of the free samples, joined one by one
// at O(|F|²); paths from there to the exact optimum. Too many steps on these paths end in the
// fallback.
std::optional<SolveReport> PathSolver::restart(DualProblem& problem, const Budget& budget) {
  if (!near_) {
    near_ = smo_.restart(problem, budget).has_value();
    move_.clear();
    return std::nullopt;
  }
  if (joined_ < problem.size()) {
    if (join_free(problem, budget, kSvr.work_slice)) {
      move_.set_bias(problem.kkt().bias());
    }
    return std::nullopt;
  }
  const std::size_t free = move_.free().size();
  Budget part = budget.within(slice(kSvr.work_path_step * problem.size() + free * free));
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
    const bool between = problem.beta()[joined_] != 0.0 && !at_bound(problem, joined_);
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
