// SPDX-License-Identifier: Apache-2.0
#include "kelpie/svr/online_svr.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>
#include <variant>

#include "core/vector.hpp"
#include "kelpie/core/scaling.hpp"
#include "svr/forgetting.hpp"
#include "svr/including_gate.hpp"
#include "svr/outlier_filter.hpp"
#include "svr/past_model.hpp"
#include "svr/path_solver.hpp"
#include "svr/sample_collector.hpp"
#include "svr/smo_solver.hpp"
#include "svr/svr_function.hpp"
#include "svr/tuning.hpp"
#include "svr/valid_sample.hpp"

namespace kelpie {
namespace {

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

struct OnlineSvr::Nodes {
  /// A sample whose weight moves to 0, and the count of the decision for its removal.
  struct Leaving {
    std::size_t sample = 0;
    int Decision::*count = nullptr;
  };

  Nodes(std::size_t inputs, std::size_t terms, const OnlineSvrSettings& settings)
      : gate(settings),
        buffer(inputs, terms, settings),
        solver(solver_of(settings, buffer.samples().capacity())),
        filter(settings),
        forgetting(settings),
        model(buffer.kernel(), buffer.samples().capacity()) {}

  IncludingGate gate;
  SampleCollector buffer;
  std::variant<PathSolver, SmoSolver> solver;
  OutlierFilter filter;
  Forgetting forgetting;
  SvrFunction model;
  SolveReport solved{.converged = true};  ///< of the buffer in its present state
  Budget budget;                          ///< of every update
  Budget left;                            ///< of the present update
  std::optional<Leaving> leaving;         ///< the removal that the last update did not complete
};

OnlineSvr::OnlineSvr(std::size_t inputs, const OnlineSvrSettings& settings, std::size_t terms)
    : settings_(validated(settings)), nodes_(std::make_unique<Nodes>(inputs, terms, settings_)) {}

OnlineSvr::OnlineSvr(const OnlineSvr& other)
    : OnlineRegressor(other),
      settings_(other.settings_),
      nodes_(std::make_unique<Nodes>(*other.nodes_)),
      progress_(other.progress_) {}

OnlineSvr::OnlineSvr(OnlineSvr&&) noexcept = default;
OnlineSvr::~OnlineSvr() = default;

OnlineSvr& OnlineSvr::operator=(const OnlineSvr& other) {
  if (nodes_ == nullptr) {
    return *this = OnlineSvr(other);
  }
  settings_ = other.settings_;
  *nodes_ = *other.nodes_;
  progress_ = other.progress_;
  return *this;
}
OnlineSvr& OnlineSvr::operator=(OnlineSvr&& other) noexcept = default;

std::size_t OnlineSvr::bytes(std::size_t inputs, const OnlineSvrSettings& settings,
                             std::size_t terms) {
  const std::size_t places = settings.places();
  return sizeof(OnlineSvr) + sizeof(Nodes) + SampleCollector::bytes(inputs, terms, settings) +
         OutlierFilter::bytes(settings) + SvrFunction::bytes(inputs, terms, places) +
         (settings.solver == SolverKind::path ? PathSolver::bytes(places) : 0);
}

void OnlineSvr::limit(const Budget& budget) {
  nodes_->budget = budget;
}

const SampleCollector& OnlineSvr::buffer() const {
  return nodes_->buffer;
}

const SvrFunction& OnlineSvr::model() const {
  return nodes_->model;
}

Decision OnlineSvr::update(std::span<const double> z, double y, double t) noexcept {
  Decision decision;
  nodes_->left = nodes_->budget;
  if (progress_.unfinished || !nodes_->solved.converged) {
    learn(decision, t);  // what earlier updates left undone
  }
  include(decision, z, y, t);  // including, eq. (9), (10)
  if (decision.verdict == Verdict::accepted) {
    nodes_->buffer.collect(z, y, t);  // sample collector
    if (progress_.unfinished) {
      ++progress_.waiting;  // learned with what is left undone
    } else {
      learn(decision, t);
    }
  }
  count(decision);
  return decision;
}

void OnlineSvr::learn(Decision& decision, double now) {
  progress_.unfinished = false;
  train(decision);        // training, eq. (4)
  reject(decision);       // outlier rejection, eq. (11), (12)
  forget(decision, now);  // forgetting, eq. (7), (8)
  repair(decision);       // training again, where a weight was pruned
  publish(decision);
  progress_.waiting = progress_.unfinished ? progress_.waiting : 0;
}

double OnlineSvr::predict(std::span<const double> z) const noexcept {
  return progress_.status.ready ? nodes_->model(z) : progress_.mean;
}

void OnlineSvr::clear() {
  nodes_->buffer.clear();
  solver().clear();
  nodes_->filter.clear();
  nodes_->model.clear();
  nodes_->solved = {.converged = true};
  nodes_->leaving.reset();
  progress_ = {};
}

Status OnlineSvr::status() const {
  Status status = progress_.status;
  status.buffer = static_cast<int>(nodes_->buffer.size());
  const std::span<const double> beta = nodes_->buffer.problem().beta();
  status.support_vectors =
      status.buffer - static_cast<int>(std::count(beta.begin(), beta.end(), 0.0));
  return status;
}

void OnlineSvr::include(Decision& decision, std::span<const double> z, double y, double t) {
  decision.had_model = progress_.status.ready;
  decision.kkt_gap = progress_.status.kkt_gap;
  if (!valid_sample(z, nodes_->buffer.samples().dimension(), y, t)) {
    decision.verdict = Verdict::invalid;
    decision.prediction.value = std::numeric_limits<double>::quiet_NaN();
    return;
  }
  if (progress_.unfinished &&
      (progress_.waiting == kSvr.most_waiting || nodes_->buffer.size() == settings_.places())) {
    decision.prediction.value = predict(z);
    decision.verdict = Verdict::crowded_out;
    return;
  }
  if (nodes_->buffer.kernel().self(z) > kSvr.most_self) {
    decision.prediction.value = predict(z);
    decision.verdict = Verdict::implausible;
    return;
  }
  nodes_->buffer.compare(z);
  for (const double kappa : nodes_->buffer.similarity()) {
    decision.similarity = std::max(decision.similarity, kappa);
  }
  decision.prediction.value = predicted(z);
  if (progress_.status.ready) {
    nodes_->filter.observe(y - decision.prediction.value);
  }
  progress_.mean += (y - progress_.mean) / static_cast<double>(++progress_.valid_samples);
  decision.verdict =
      nodes_->gate.check(nodes_->buffer.similarity(), nodes_->buffer.problem().targets(),
                         decision.prediction.value, y);
}

// The row at hand gives the model in service for nothing, unless an older one is in service.
double OnlineSvr::predicted(std::span<const double> z) const {
  if (!progress_.current) {
    return predict(z);
  }
  return dot(nodes_->buffer.problem().beta(), nodes_->buffer.row()) + nodes_->model.bias();
}

void OnlineSvr::train(Decision& decision) {
  if (nodes_->leaving && !remove(decision, nodes_->leaving->sample, nodes_->leaving->count)) {
    return;
  }
  nodes_->solved = solver().solve(nodes_->buffer.problem(), nodes_->left);
  decision.iterations += nodes_->solved.iterations;
  decision.fallbacks += nodes_->solved.fell_back ? 1 : 0;
  decision.kkt_gap = nodes_->solved.kkt_gap;
  progress_.unfinished = nodes_->left.exhausted();
}

void OnlineSvr::reject(Decision& decision) {
  if (progress_.unfinished) {
    return;
  }
  for (const std::size_t i :
       nodes_->filter.find_outliers(nodes_->buffer, nodes_->buffer.problem().kkt().bias())) {
    if (!remove(decision, i, &Decision::outliers)) {
      return;
    }
  }
}

void OnlineSvr::forget(Decision& decision, double now) {
  while (!progress_.unfinished) {
    const std::optional<std::size_t> i = nodes_->forgetting.released(nodes_->buffer);
    if (!i) {
      break;
    }
    remove(decision, *i, &Decision::released);
  }
  while (!progress_.unfinished) {
    const std::optional<std::size_t> i = nodes_->forgetting.forgotten(nodes_->buffer, now);
    if (!i) {
      break;
    }
    remove(decision, *i, &Decision::forgotten);
  }
}

void OnlineSvr::repair(Decision& decision) {
  if (progress_.pruned_weight && !progress_.unfinished) {
    train(decision);
    progress_.pruned_weight = progress_.unfinished;
  }
}

void OnlineSvr::publish(Decision& decision) {
  progress_.current =
      nodes_->solved.converged && !progress_.unfinished && nodes_->buffer.size() > 0;
  decision.published = decision.published || progress_.current;
  if (progress_.current) {
    const DualProblem& problem = nodes_->buffer.problem();
    nodes_->model.assign(nodes_->buffer.samples(), problem.beta(), problem.kkt().bias());
    progress_.status.kkt_gap = nodes_->solved.kkt_gap;
    progress_.status.ready = true;
  }
}

// False when the budget ran out on the way: the sample is still there, and leaves with the next
// update.
bool OnlineSvr::remove(Decision& decision, std::size_t i, int Decision::*count) {
  progress_.pruned_weight = progress_.pruned_weight || !weightless(nodes_->buffer, i);
  const SolveReport released = solver().release(nodes_->buffer.problem(), i, nodes_->left);
  decision.iterations += released.iterations;
  progress_.unfinished = nodes_->left.exhausted();
  if (progress_.unfinished) {
    nodes_->leaving = {.sample = i, .count = count};
    return false;
  }
  nodes_->leaving.reset();
  nodes_->buffer.remove(i);
  solver().removed(nodes_->buffer.problem(), i);
  ++(decision.*count);
  return true;
}

void OnlineSvr::relearn(const PastModel& past, double now) {
  clear();
  // Under a spent budget the solver would never come to an end.
  const Budget budget = std::exchange(nodes_->budget, Budget{});
  while (!progress_.relearned) {
    relearn_slice(past, now);
  }
  nodes_->budget = budget;
}

bool OnlineSvr::relearn_slice(const PastModel& past, double now) {
  if (progress_.relearned) {
    return release_slice();
  }
  const std::size_t samples = std::min(past.size(), settings_.places() - 1);
  if (nodes_->buffer.size() < samples) {
    collect_slice(past, samples, now);
    if (nodes_->buffer.size() == samples) {
      warm_start(past.function);
    }
    return false;
  }
  const std::optional<SolveReport> solved =
      solver().restart(nodes_->buffer.problem(), nodes_->budget);
  if (solved) {
    nodes_->solved = *solved;
    Decision decision;
    publish(decision);
    progress_.relearned = true;
  }
  return false;
}

// Of another scale's samples hundreds may be without weight: more than one update can let go.
bool OnlineSvr::release_slice() {
  Decision decision;
  nodes_->left = nodes_->budget;
  for (std::size_t work = 0; work < kSvr.slice_of_rows; work += 3 * nodes_->buffer.size()) {
    const std::optional<std::size_t> i = nodes_->forgetting.released(nodes_->buffer);
    if (!i) {
      return true;
    }
    if (!nodes_->left.spend(kSvr.element_work * nodes_->buffer.size())) {
      break;
    }
    remove(decision, *i, &Decision::released);
  }
  return false;
}

// The weights that the samples had, which a solver need not find again. None unless the function is
// that of these samples.
void OnlineSvr::warm_start(const SvrFunction& function) {
  DualProblem& problem = nodes_->buffer.problem();
  const SampleStore& vectors = function.support_vectors();
  std::array<double, kMostInputs + kMostTerms> room{};
  std::array<double, kMostInputs> vector_room{};
  const std::span<double> z = std::span(room).first(vectors.dimension());
  const std::span<double> vector = std::span(vector_room).first(vectors.dimension());
  std::size_t known = 0;
  for (std::size_t i = 0; i < nodes_->buffer.size() && known < vectors.size(); ++i) {
    nodes_->buffer.samples().get(i, z);
    vectors.get(known, vector);
    if (std::ranges::equal(z, vector)) {
      problem.set_beta(i, function.beta()[known++]);
    }
  }
  for (std::size_t i = 0; i < nodes_->buffer.size(); ++i) {
    if (known < vectors.size()) {
      problem.set_beta(i, 0.0);
    }
    renew(problem, i);
  }
}

void OnlineSvr::collect_slice(const PastModel& past, std::size_t samples, double now) {
  std::array<double, kMostInputs + kMostTerms> place{};
  const std::span<double> z = std::span(place).first(nodes_->buffer.samples().dimension());
  const double latest = past.latest_s();
  Budget part = nodes_->budget;
  std::size_t work = 0;
  for (std::size_t i = nodes_->buffer.size();
       i < samples && work < kSvr.slice_of_rows && part.spend(kSvr.element_work * i); ++i) {
    past.samples.get(i, z);
    const double y = past.targets[i];
    nodes_->buffer.compare(z);
    nodes_->buffer.collect(z, y, now + (past.times_s[i] - latest));
    progress_.mean += (y - progress_.mean) / static_cast<double>(++progress_.valid_samples);
    work += i + 1;
  }
}

void OnlineSvr::visit(Archive& archive) {
  archive.part("buffer", nodes_->buffer);
  archive.part("solver", solver(), nodes_->buffer.problem());
  archive.part("outliers", nodes_->filter);
  archive.part("model", nodes_->model);
  archive.part("solved", nodes_->solved);
  archive.flag(progress_.pruned_weight);
  archive.flag(progress_.unfinished);
  archive.whole(progress_.waiting, 0, kSvr.most_waiting);
  visit_leaving(archive);
  archive.flag(progress_.current);
  archive.flag(progress_.relearned);
  archive.number(progress_.mean);
  archive.whole(progress_.valid_samples);
  archive.part("status", progress_.status);
  const bool room = progress_.unfinished || nodes_->buffer.size() < settings_.places();
  archive.require(room, "has no place for the next sample");
}

void OnlineSvr::visit_leaving(Archive& archive) {
  constexpr std::array kCounts{&Decision::outliers, &Decision::released, &Decision::forgotten};
  Nodes::Leaving leaving =
      nodes_->leaving.value_or(Nodes::Leaving{.sample = 0, .count = kCounts.front()});
  bool is_leaving = nodes_->leaving.has_value();
  archive.flag(is_leaving);
  std::ptrdiff_t count = std::ranges::find(kCounts, leaving.count) - kCounts.begin();
  archive.whole(count, 0, std::ssize(kCounts) - 1);
  archive.whole(leaving.sample);
  if (archive.loading() && is_leaving) {
    archive.require(leaving.sample < nodes_->buffer.size(), "removes a sample that there isn't");
    nodes_->leaving = {.sample = leaving.sample, .count = kCounts[static_cast<std::size_t>(count)]};
  }
}

Solver& OnlineSvr::solver() {
  return std::visit([](Solver& any) -> Solver& { return any; }, nodes_->solver);
}

void OnlineSvr::count(Decision& decision) {
  decision.unfinished = progress_.unfinished;
  decision.rejected_by_tolerance = !nodes_->solved.converged;
  progress_.status.tally.add(decision);
}

}  // namespace kelpie
