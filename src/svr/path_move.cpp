// SPDX-License-Identifier: Apache-2.0
#include "kelpie/svr/path_move.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kelpie/core/vector.hpp"

namespace kelpie {
namespace {

// Rates below this share of the move's size are rounding, not motion.
constexpr double kStill = 1e-13;

}  // namespace

Branch branch_at(const DualProblem& problem, std::size_t i, bool lower_edge) {
  if (problem.epsilon() == 0.0) {
    return Branch::both;
  }
  const double beta = problem.beta()[i];
  const bool positive = lower_edge ? beta >= 0.0 : beta > 0.0;
  return positive ? Branch::positive : Branch::negative;
}

std::pair<double, double> weights_of(Branch branch, double c) {
  return {branch == Branch::positive ? 0.0 : -c, branch == Branch::negative ? 0.0 : c};
}

PathMove::PathMove(std::size_t capacity)
    : free_(capacity),
      d_beta_(capacity + 1),
      d_free_residual_(capacity),
      d_gradient_(capacity),
      spread_(capacity) {
  who_.reserve(capacity + 1);
}

double PathMove::off_edge(const DualProblem& problem, std::size_t place) const {
  const double edge = static_cast<double>(free_.branch(place)) * problem.epsilon();
  return problem.gradient()[free_.members()[place]] - bias_ - edge;
}

double PathMove::head(const DualProblem& problem, std::size_t c, double s) {
  const std::size_t m = free_.size();
  who_.assign(free_.members().begin(), free_.members().end());
  who_.push_back(c);
  d_bias_ = free_.follow(s, std::span(d_beta_).first(m));
  d_beta_[m] = s;
  std::fill_n(d_free_residual_.begin(), m, 0.0);
  rates(problem);
  return d_gradient_[c] - d_bias_;
}

void PathMove::correction(const DualProblem& problem) {
  const std::size_t m = free_.size();
  who_.assign(free_.members().begin(), free_.members().end());
  for (std::size_t k = 0; k < m; ++k) {
    d_beta_[k] = off_edge(problem, k);
    d_free_residual_[k] = -d_beta_[k];
  }
  const std::span<const double> beta = problem.beta();
  d_bias_ =
      free_.correct(-std::accumulate(beta.begin(), beta.end(), 0.0), std::span(d_beta_).first(m));
  rates(problem);
}

void PathMove::rates(const DualProblem& problem) {
  const std::size_t n = problem.size();
  const std::span<double> rates = std::span(d_gradient_).first(n);
  const std::span<double> moves = std::span(d_beta_).first(who_.size());
  size_ = 0.0;
  for (const double d_beta : moves) {
    size_ += std::abs(d_beta);
  }
  if (who_.size() <= n / 2) {
    std::ranges::fill(rates, 0.0);
    problem.kernel().combine(who_, moves, rates);
    for (double& rate : rates) {
      rate = -rate;
    }
    return;
  }
  // Most samples are free, and how their residuals change is known: only the others are computed.
  const std::span<double> spread = std::span(spread_).first(n);
  std::ranges::fill(spread, 0.0);
  for (std::size_t k = 0; k < who_.size(); ++k) {
    spread[who_[k]] = moves[k];
  }
  for (std::size_t j = 0; j < n; ++j) {
    rates[j] = free_.contains(j) ? d_bias_ + d_free_residual_[free_.place(j)]
                                 : -problem.kernel().dot(j, spread);
  }
}

PathEvent PathMove::first_event(const DualProblem& problem, double longest, double slack,
                                std::size_t apart) const {
  PathEvent event{.step = longest};
  const double still = kStill * size_;
  for (std::size_t k = 0; k < free_.size(); ++k) {
    const double rate = d_beta_[k];
    const auto [low, high] = weights_of(free_.branch(k), problem.c());
    const double end = rate > 0.0 ? high : low;
    const double room = std::abs(end - problem.beta()[free_.members()[k]]);
    if (room < event.step * std::abs(rate)) {
      event = {.kind = PathEvent::Kind::leaves,
               .step = room / std::abs(rate),
               .sample = free_.members()[k],
               .weight = end};
    }
  }
  for (std::size_t j = 0; j < problem.size(); ++j) {
    const double rate = d_gradient_[j] - d_bias_;
    if (std::abs(rate) <= still || j == apart || free_.contains(j)) {
      continue;
    }
    const bool rises = rate > 0.0;
    const double room = rises ? bias_ - problem.lower_bound(j) : problem.upper_bound(j) - bias_;
    if (room >= -slack && room < event.step * std::abs(rate)) {
      event = {.kind = PathEvent::Kind::joins,
               .step = std::max(room, 0.0) / std::abs(rate),
               .sample = j,
               .branch = branch_at(problem, j, rises)};
    }
  }
  return event;
}

void PathMove::apply(DualProblem& problem, const PathEvent& event) {
  problem.advance(event.step, who_, std::span(d_beta_).first(who_.size()),
                  std::span(d_gradient_).first(problem.size()));
  bias_ += event.step * d_bias_;
  if (event.kind == PathEvent::Kind::leaves) {
    problem.settle(event.sample, event.weight);
    free_.leave(free_.place(event.sample));
  } else if (event.kind == PathEvent::Kind::joins) {
    free_.join(problem.kernel(), event.sample, event.branch);
  }
}

}  // namespace kelpie
