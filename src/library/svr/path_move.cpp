// SPDX-License-Identifier: Apache-2.0
#include "svr/path_move.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/vector.hpp"
#include "svr/tuning.hpp"

namespace kelpie {
namespace {

std::size_t places(std::size_t capacity) {
  return std::max(kSvr.least_watched, capacity / kSvr.watched_part);
}

void shift_gradient(DualProblem& problem, std::size_t i, double change) {
  problem.set_gradient(i, problem.gradient()[i] + change);
}

double distance_to_edge(const DualProblem& problem, std::size_t i, double bias) {
  return std::min(bias - problem.lower_bound(i), problem.upper_bound(i) - bias);
}

}  // namespace

Branch branch_at(const DualProblem& problem, std::size_t i, bool lower_edge) {
  if (problem.loss().epsilon == 0.0) {
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
      watch_(places(capacity), capacity),
      d_beta_(capacity),
      d_off_(capacity),
      spread_(capacity),
      product_(capacity),
      weight_before_(capacity),
      has_moved_(capacity),
      change_(capacity) {
  moved_.reserve(capacity);
}

std::size_t PathMove::bytes(std::size_t capacity) {
  constexpr std::size_t kVectors = 6;
  return FreeSet::bytes(capacity) + WatchList::bytes(places(capacity), capacity) +
         capacity * (sizeof(std::size_t) + sizeof(char) + kVectors * sizeof(double));
}

void PathMove::join(const DualProblem& problem, std::size_t sample, Branch branch) {
  if (watch_.watches(sample)) {
    watch_.unwatch(sample);
  }
  if (sample != head_) {
    watch_.add_mover(problem.kernel(), sample);
  }
  free_.join(problem.kernel(), sample, branch);
}

void PathMove::leave(const DualProblem& problem, std::size_t sample) {
  free_.leave(free_.place(sample));
  watch_.remove_mover(sample);
  watch(problem, sample);
}

void PathMove::renumber(std::size_t from, std::size_t to) {
  if (free_.contains(to)) {
    free_.leave(free_.place(to));
    watch_.remove_mover(to);
  }
  if (watch_.watches(to)) {
    watch_.unwatch(to);
  }
  free_.renumber(from, to);
  watch_.renumber(from, to);
}

void PathMove::clear() {
  free_.clear();
  watch_.clear();
  bias_ = 0.0;
  nearness_ = kSvr.nearness;
}

void PathMove::begin(const DualProblem& problem, std::size_t c, double slack) {
  slack_ = slack;
  head_ = c;
  if (c != kNone) {
    if (watch_.watches(c)) {
      watch_.unwatch(c);
    }
    free_.aim(problem.kernel(), c);
    watch_.add_mover(problem.kernel(), c);
  }
  watch_nearest(problem);
}

void PathMove::end(DualProblem& problem) {
  refresh(problem);
  if (head_ != kNone && !free_.contains(head_)) {
    watch_.remove_mover(head_);
  }
  head_ = kNone;
}

void PathMove::refresh(DualProblem& problem) {
  const std::size_t n = problem.size();
  const std::span<double> change = std::span(change_).first(n);
  std::ranges::fill(change, 0.0);
  for (std::size_t k = 0; k < moved_.size(); ++k) {
    const std::size_t i = moved_[k];
    weight_before_[k] = problem.beta()[i] - weight_before_[k];
    has_moved_[i] = 0;
  }
  problem.kernel().combine(moved_, std::span(weight_before_).first(moved_.size()), change);
  moved_.clear();
  for (std::size_t j = 0; j < n; ++j) {
    if (j != head_ && !free_.contains(j) && !watch_.watches(j)) {
      shift_gradient(problem, j, -change[j]);
    }
  }
}

void PathMove::visit(Archive& archive, const DualProblem& problem) {
  archive.part("free", free_, problem.size());
  archive.part("watched", watch_, problem.kernel());
  archive.number(bias_);
  archive.any_number(nearness_);  // grows without bound where there is room for all
  const auto is_free = [this](std::size_t sample) { return free_.contains(sample); };
  archive.require(watch_.movers().size() == free_.size() &&
                      std::ranges::all_of(watch_.movers(), is_free) &&
                      std::ranges::none_of(watch_.watched(), is_free),
                  "moves others than the free samples");
}

// Samples far from their edges come and go with the room that there is for the near ones.
void PathMove::watch_nearest(const DualProblem& problem) {
  for (std::size_t k = watch_.watched().size(); k-- > 0;) {
    const std::size_t i = watch_.watched()[k];
    if (distance_to_edge(problem, i, bias_) > 2.0 * nearness_) {
      watch_.unwatch(i);
    }
  }
  const std::size_t room = watch_.places() * 7 / 8;  // the rest is for samples that leave F
  bool full = false;
  for (std::size_t j = 0; j < problem.size() && !full; ++j) {
    if (j != head_ && !free_.contains(j) && !watch_.watches(j) &&
        distance_to_edge(problem, j, bias_) <= nearness_) {
      full = watch_.watched().size() >= room;
      if (!full) {
        watch_.watch(problem.kernel(), j);
      }
    }
  }
  nearness_ *= full ? kSvr.nearness_shrinks
                    : (watch_.watched().size() < room / 2 ? kSvr.nearness_grows : 1.0);
}

void PathMove::watch(const DualProblem& problem, std::size_t sample) {
  if (watch_.watched().size() == watch_.places()) {
    const auto distance = [&](std::size_t i) { return distance_to_edge(problem, i, bias_); };
    watch_.unwatch(*std::ranges::max_element(watch_.watched(), {}, distance));
  }
  watch_.watch(problem.kernel(), sample);
}

double off_edge(const DualProblem& problem, const PathMove& move, std::size_t place) {
  const FreeSet& free = move.free();
  const double edge = static_cast<double>(free.branch(place)) * problem.loss().epsilon;
  return problem.gradient()[free.members()[place]] - move.bias() - edge;
}

double PathMove::head(const DualProblem& problem, double s) {
  const std::size_t m = free_.size();
  d_bias_ = free_.follow(s, std::span(d_beta_).first(m));
  std::fill_n(d_off_.begin(), m, 0.0);
  spread_[head_] = s;
  rates();
  const std::span<double> row = std::span(change_).first(m);
  problem.kernel().gather(head_, free_.members(), row);
  d_head_ = -s * problem.kernel()(head_, head_) - dot(row, std::span(d_beta_).first(m));
  return d_head_ - d_bias_;
}

void PathMove::correction(const DualProblem& problem) {
  const std::size_t m = free_.size();
  for (std::size_t k = 0; k < m; ++k) {
    d_beta_[k] = off_edge(problem, *this, k);
    d_off_[k] = -d_beta_[k];
  }
  const std::span<const double> beta = problem.beta();
  d_bias_ =
      free_.correct(-std::accumulate(beta.begin(), beta.end(), 0.0), std::span(d_beta_).first(m));
  rates();
}

void PathMove::rates() {
  size_ = 0.0;
  for (std::size_t k = 0; k < free_.size(); ++k) {
    spread_[free_.members()[k]] = d_beta_[k];
    size_ += std::abs(d_beta_[k]);
  }
  watch_.products(spread_, product_);
}

PathEvent PathMove::first_event(const DualProblem& problem, double longest) const {
  PathEvent event{.step = longest};
  for (std::size_t k = 0; k < free_.size(); ++k) {
    const double rate = d_beta_[k];
    const auto [low, high] = weights_of(free_.branch(k), problem.loss().c);
    const double end = rate > 0.0 ? high : low;
    const double room = std::abs(end - problem.beta()[free_.members()[k]]);
    if (room < event.step * std::abs(rate)) {
      event = {.kind = PathEvent::Kind::leaves,
               .step = room / std::abs(rate),
               .sample = free_.members()[k],
               .weight = end};
    }
  }
  const std::span<const std::size_t> watched = watch_.watched();
  for (std::size_t k = 0; k < watched.size(); ++k) {
    const std::size_t j = watched[k];
    const double rate = -product_[k] - d_bias_;
    const bool rises = rate > 0.0;
    const double room = rises ? bias_ - problem.lower_bound(j) : problem.upper_bound(j) - bias_;
    if (room >= -slack_ && room < event.step * std::abs(rate) &&
        std::abs(rate) > kSvr.still * size_) {
      event = {.kind = PathEvent::Kind::joins,
               .step = std::max(room, 0.0) / std::abs(rate),
               .sample = j,
               .branch = branch_at(problem, j, rises)};
    }
  }
  return event;
}

void PathMove::apply(DualProblem& problem, const PathEvent& event) {
  const auto move = [&](std::size_t i) {
    if (has_moved_[i] == 0) {
      has_moved_[i] = 1;
      weight_before_[moved_.size()] = problem.beta()[i];
      moved_.push_back(i);
    }
    problem.set_beta(i, problem.beta()[i] + event.step * spread_[i]);
  };
  for (std::size_t k = 0; k < free_.size(); ++k) {
    const std::size_t i = free_.members()[k];
    move(i);
    shift_gradient(problem, i, event.step * (d_bias_ + d_off_[k]));
  }
  if (head_ != kNone) {
    move(head_);
    shift_gradient(problem, head_, event.step * d_head_);
  }
  for (std::size_t k = 0; k < watch_.watched().size(); ++k) {
    shift_gradient(problem, watch_.watched()[k], -event.step * product_[k]);
  }
  bias_ += event.step * d_bias_;
  if (event.kind == PathEvent::Kind::leaves) {
    problem.set_beta(event.sample, event.weight);
    leave(problem, event.sample);
  } else if (event.kind == PathEvent::Kind::joins) {
    join(problem, event.sample, event.branch);
  }
}

}  // namespace kelpie
