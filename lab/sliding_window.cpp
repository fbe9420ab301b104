// SPDX-License-Identifier: Apache-2.0
#include "lab/sliding_window.hpp"
#include "kelpie/svr/resources.hpp"

#include <algorithm>

namespace kelpie::lab {
namespace {

void add_to(SolveReport& report, const SolveReport& more) {
  report.iterations += more.iterations;
  report.kkt_gap = more.kkt_gap;
  report.converged = more.converged;
  report.fell_back = report.fell_back || more.fell_back;
}

}  // namespace

SlidingWindow::SlidingWindow(std::size_t inputs, const OnlineSvrSettings& settings)
    : settings_(settings),
      kernel_(settings.gamma),
      samples_(inputs, settings.places()),
      problem_(settings.places(), settings.epsilon, settings.c, settings.storage),
      solver_(PathSolver(settings.places(), settings.tolerance, settings.max_iterations)),
      row_(settings.places()),
      arrival_(settings.places()) {
  if (settings.solver == SolverKind::smo) {
    switch_to_smo();
  }
}

void SlidingWindow::switch_to_smo() {
  solver_ = SmoSolver(settings_.tolerance, settings_.max_iterations);
}

SolveReport SlidingWindow::step(std::span<const double> z, double y) {
  const std::size_t n = size();
  kernel_.row(z, samples_, row_);
  problem_.add(std::span(row_).first(n), 1.0 + settings_.effective_ridge(), y);
  samples_.push_back(z);
  arrival_[n] = next_arrival_++;
  Budget budget;
  SolveReport report = solver().solve(problem_, budget);
  if (size() == settings_.places()) {
    remove_oldest(report);
  }
  return report;
}

void SlidingWindow::remove_oldest(SolveReport& report) {
  const auto oldest =
      static_cast<std::size_t>(std::ranges::min_element(arrival_) - arrival_.begin());
  Budget budget;
  add_to(report, solver().release(problem_, oldest, budget));
  problem_.remove(oldest);
  samples_.remove(oldest);
  arrival_[oldest] = arrival_[size()];
  solver().removed(problem_, oldest);
  add_to(report, solver().solve(problem_, budget));
}

std::size_t SlidingWindow::free_samples() const {
  const auto* const path = std::get_if<PathSolver>(&solver_);
  return path == nullptr ? 0 : path->free_samples();
}

Solver& SlidingWindow::solver() {
  return std::visit([](Solver& any) -> Solver& { return any; }, solver_);
}

}  // namespace kelpie::lab
