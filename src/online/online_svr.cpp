// SPDX-License-Identifier: Apache-2.0
#include "kelpie/online/online_svr.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "kelpie/core/scaling.hpp"
#include "kelpie/core/vector.hpp"
#include "kelpie/online/valid_sample.hpp"

namespace kelpie {
namespace {

// Where a sample's physics terms are larger, what else the kernel tells is lost in rounding.
constexpr double kMostSelf = 1e6;

constexpr int kMostWaiting = 8;  // samples: the model in service gets no older

OnlineSvrSettings validated(const OnlineSvrSettings& settings) {
  settings.validate();
  return settings;
}

std::variant<PathSolver, SmoSolver> solver_of(const OnlineSvrSettings& settings,
                                              std::size_t capacity) {
  if (settings.solver == SolverKind::smo) {
    return SmoSolver(settings.tolerance, settings.max_iterations);
  }
  return PathSolver(capacity, settings.tolerance, settings.max_iterations);
}

}  // namespace

OnlineSvr::OnlineSvr(std::size_t inputs, const OnlineSvrSettings& settings, std::size_t terms)
    : settings_(validated(settings)),
      gate_(settings_),
      buffer_(inputs, terms, settings_),
      solver_(solver_of(settings_, buffer_.samples().capacity())),
      filter_(settings_),
      forgetting_(settings_),
      model_(buffer_.kernel(), buffer_.samples().capacity()) {}

std::size_t OnlineSvr::bytes(std::size_t inputs, const OnlineSvrSettings& settings,
                             std::size_t terms) {
  const std::size_t places = settings.places();
  return sizeof(OnlineSvr) + SampleCollector::bytes(inputs, terms, settings) +
         OutlierFilter::bytes(settings) + SvrFunction::bytes(inputs, terms, places) +
         (settings.solver == SolverKind::path ? PathSolver::bytes(places) : 0);
}

Decision OnlineSvr::update(std::span<const double> z, double y, double t) noexcept {
  Decision decision;
  left_ = budget_;
  if (unfinished_ || !solved_.converged) {
    learn(decision, t);  // what earlier updates left undone
  }
  include(decision, z, y, t);  // including, eq. (9), (10)
  if (decision.verdict == Verdict::accepted) {
    buffer_.collect(z, y, t);  // sample collector
    if (unfinished_) {
      ++waiting_;  // learned with what is left undone
    } else {
      learn(decision, t);
    }
  }
  count(decision);
  return decision;
}

void OnlineSvr::learn(Decision& decision, double now) {
  unfinished_ = false;
  train(decision);        // training, eq. (4)
  reject(decision);       // outlier rejection, eq. (11), (12)
  forget(decision, now);  // forgetting, eq. (7), (8)
  repair(decision);       // training again, where a weight was pruned
  publish(decision);
  waiting_ = unfinished_ ? waiting_ : 0;
}

double OnlineSvr::predict(std::span<const double> z) const noexcept {
  return status_.ready ? model_(z) : mean_;
}

void OnlineSvr::clear() {
  buffer_.clear();
  solver().clear();
  filter_.clear();
  model_.clear();
  solved_ = {.converged = true};
  pruned_weight_ = false;
  unfinished_ = false;
  waiting_ = 0;
  leaving_.reset();
  current_ = false;
  relearned_ = false;
  mean_ = 0.0;
  valid_samples_ = 0;
  status_ = {};
}

Status OnlineSvr::status() const {
  Status status = status_;
  status.buffer = static_cast<int>(buffer_.size());
  status.support_vectors = static_cast<int>(buffer_.support_vectors());
  return status;
}

void OnlineSvr::include(Decision& decision, std::span<const double> z, double y, double t) {
  decision.had_model = status_.ready;
  decision.kkt_gap = status_.kkt_gap;
  if (!valid_sample(z, buffer_.samples().dimension(), y, t)) {
    decision.verdict = Verdict::invalid;
    return;
  }
  if (unfinished_ && (waiting_ == kMostWaiting || buffer_.size() == settings_.places())) {
    decision.prediction.value = predict(z);
    decision.verdict = Verdict::crowded_out;
    return;
  }
  if (buffer_.kernel().self(z) > kMostSelf) {
    decision.prediction.value = predict(z);
    decision.verdict = Verdict::implausible;
    return;
  }
  buffer_.compare(z);
  for (const double kappa : buffer_.similarity()) {
    decision.similarity = std::max(decision.similarity, kappa);
  }
  decision.prediction.value = predicted(z);
  if (status_.ready) {
    filter_.observe(y - decision.prediction.value);
  }
  mean_ += (y - mean_) / static_cast<double>(++valid_samples_);
  decision.verdict =
      gate_.check(buffer_.similarity(), buffer_.problem().targets(), decision.prediction.value, y);
}

// The row at hand gives the model in service for nothing, unless an older one is in service.
double OnlineSvr::predicted(std::span<const double> z) const {
  if (!current_) {
    return predict(z);
  }
  return dot(buffer_.problem().beta(), buffer_.row()) + model_.bias();
}

void OnlineSvr::train(Decision& decision) {
  if (leaving_ && !remove(decision, leaving_->sample, leaving_->count)) {
    return;
  }
  solved_ = solver().solve(buffer_.problem(), left_);
  decision.iterations += solved_.iterations;
  decision.fallbacks += solved_.fell_back ? 1 : 0;
  decision.kkt_gap = solved_.kkt_gap;
  unfinished_ = left_.exhausted();
}

void OnlineSvr::reject(Decision& decision) {
  if (unfinished_) {
    return;
  }
  for (const std::size_t i : filter_.find_outliers(buffer_, buffer_.problem().kkt().bias())) {
    if (!remove(decision, i, &Decision::outliers)) {
      return;
    }
  }
}

void OnlineSvr::forget(Decision& decision, double now) {
  while (!unfinished_) {
    const std::optional<std::size_t> i = forgetting_.released(buffer_);
    if (!i) {
      break;
    }
    remove(decision, *i, &Decision::released);
  }
  while (!unfinished_) {
    const std::optional<std::size_t> i = forgetting_.forgotten(buffer_, now);
    if (!i) {
      break;
    }
    remove(decision, *i, &Decision::forgotten);
  }
}

void OnlineSvr::repair(Decision& decision) {
  if (pruned_weight_ && !unfinished_) {
    train(decision);
    pruned_weight_ = unfinished_;
  }
}

void OnlineSvr::publish(Decision& decision) {
  current_ = solved_.converged && !unfinished_ && buffer_.size() > 0;
  decision.published = decision.published || current_;
  if (current_) {
    const DualProblem& problem = buffer_.problem();
    model_.assign(buffer_.samples(), problem.beta(), problem.kkt().bias());
    status_.kkt_gap = solved_.kkt_gap;
    status_.ready = true;
  }
}

// False when the budget ran out on the way: the sample is still there, and leaves with the next
// update.
bool OnlineSvr::remove(Decision& decision, std::size_t i, int Decision::*count) {
  pruned_weight_ = pruned_weight_ || !buffer_.idle(i);
  const SolveReport released = solver().release(buffer_.problem(), i, left_);
  decision.iterations += released.iterations;
  unfinished_ = left_.exhausted();
  if (unfinished_) {
    leaving_ = {.sample = i, .count = count};
    return false;
  }
  leaving_.reset();
  buffer_.remove(i);
  solver().removed(buffer_.problem(), i);
  ++(decision.*count);
  return true;
}

void OnlineSvr::visit(Archive& archive) {
  archive.part("buffer", buffer_);
  archive.part("solver", solver(), buffer_.problem());
  archive.part("outliers", filter_);
  archive.part("model", model_);
  archive.part("solved", solved_);
  archive.flag(pruned_weight_);
  archive.flag(unfinished_);
  archive.whole(waiting_, 0, kMostWaiting);
  visit_leaving(archive);
  archive.flag(current_);
  archive.flag(relearned_);
  archive.number(mean_);
  archive.whole(valid_samples_);
  archive.part("status", status_);
  const bool room = unfinished_ || buffer_.size() < settings_.places();
  archive.require(room, "has no place for the next sample");
}

void OnlineSvr::visit_leaving(Archive& archive) {
  constexpr std::array kCounts{&Decision::outliers, &Decision::released, &Decision::forgotten};
  Leaving leaving = leaving_.value_or(Leaving{.sample = 0, .count = kCounts.front()});
  bool somebody = leaving_.has_value();
  archive.flag(somebody);
  std::ptrdiff_t count = std::ranges::find(kCounts, leaving.count) - kCounts.begin();
  archive.whole(count, 0, std::ssize(kCounts) - 1);
  archive.whole(leaving.sample);
  if (archive.loading() && somebody) {
    archive.require(leaving.sample < buffer_.size(), "removes a sample that there isn't");
    leaving_ = {.sample = leaving.sample, .count = kCounts[static_cast<std::size_t>(count)]};
  }
}

Solver& OnlineSvr::solver() {
  return std::visit([](Solver& any) -> Solver& { return any; }, solver_);
}

void OnlineSvr::count(Decision& decision) {
  decision.unfinished = unfinished_;
  decision.rejected_by_tolerance = !solved_.converged;
  status_.tally.add(decision);
}

}  // namespace kelpie
