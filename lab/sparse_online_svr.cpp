// SPDX-License-Identifier: Apache-2.0
#include "lab/sparse_online_svr.hpp"

#include "kelpie/svr/resources.hpp"
#include "svr/valid_sample.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace kelpie::lab {
namespace {

using Sparse = SparseOnlineSvrSettings;

constexpr Range kAboveZero{.low = 0.0, .open = true};

constexpr std::array kSparseFields = std::to_array<Setting<Sparse>>({
    {"dictionary", "samples kept at most", &Sparse::dictionary, {.low = 2.0, .high = 20'000.0}},
    {"threshold",
     "η: independence above which a sample enters",
     &Sparse::threshold,
     {.low = 0.0, .high = 1.0}},
    {"fade_s", "age at which independence has faded to exp(−½), in s", &Sparse::fade_s, kAboveZero},
    {"ridge", "λ: added to the diagonal of K", &Sparse::ridge, {.low = 1e-12, .high = 1.0}},
    {"epsilon", "ε: half width of the tube", &Sparse::epsilon, {.low = 0.0}},
    {"c", "C: bound of a weight", &Sparse::c, kAboveZero},
    {"gamma", "γ: κ = exp(−γ |z − z'|²)", &Sparse::gamma, kAboveZero},
    {"tolerance",
     "KKT gap up to which a model is served",
     &Sparse::tolerance,
     {.low = 0.0, .high = 1.0, .open = true}},
    {"max_iterations", "of the solver, for one solve", &Sparse::max_iterations, {.low = 1.0}},
});

Sparse validated(const Sparse& settings) {
  settings.validate();
  return settings;
}

std::size_t places(const Sparse& settings) {
  return static_cast<std::size_t>(settings.dictionary);
}

}  // namespace

std::span<const Setting<SparseOnlineSvrSettings>> sparse_online_svr_fields() {
  return kSparseFields;
}

void SparseOnlineSvrSettings::validate() const {
  for (const Setting<Sparse>& field : kSparseFields) {
    field.check(*this);
  }
}

SparseOnlineSvr::SparseOnlineSvr(std::size_t inputs, const Sparse& settings)
    : settings_(validated(settings)),
      kernel_(settings_.gamma),
      samples_(inputs, places(settings_)),
      time_(places(settings_)),
      row_(places(settings_)),
      problem_(places(settings_), settings_.epsilon, settings_.c),
      inverse_(places(settings_), settings_.ridge),
      solver_(places(settings_), settings_.tolerance, settings_.max_iterations),
      model_({kernel_, inputs}, places(settings_)) {}

Decision SparseOnlineSvr::update(std::span<const double> z, double y, double t) {
  Decision decision;
  include(decision, z, y, t);
  if (decision.verdict == Verdict::accepted) {
    collect(z, y, t);
  }
  if (decision.verdict == Verdict::accepted || !solved_.converged) {
    train(decision);
  }
  decision.rejected_by_tolerance = !solved_.converged;
  status_.tally.add(decision);
  return decision;
}

double SparseOnlineSvr::predict(std::span<const double> z) const {
  return status_.ready ? model_(z) : mean_;
}

Status SparseOnlineSvr::status() const {
  Status status = status_;
  const std::span<const double> beta = problem_.beta();
  status.buffer = static_cast<int>(beta.size());
  status.support_vectors =
      static_cast<int>(beta.size()) - static_cast<int>(std::ranges::count(beta, 0.0));
  return status;
}

void SparseOnlineSvr::include(Decision& decision, std::span<const double> z, double y, double t) {
  decision.had_model = status_.ready;
  decision.kkt_gap = status_.kkt_gap;
  if (!valid_sample(z, samples_.dimension(), y, t)) {
    decision.verdict = Verdict::invalid;
    return;
  }
  decision.prediction.value = predict(z);
  mean_ += (y - mean_) / static_cast<double>(++valid_samples_);
  kernel_.row(z, samples_, row_);
  const double delta = inverse_.independence(std::span(row_).first(samples_.size()), 1.0);
  if (delta <= settings_.threshold || !make_room(decision, delta, t)) {
    decision.verdict = Verdict::explained;
  }
}

// Whether there is a place for a newcomer, or was made by letting go who is worth less.
bool SparseOnlineSvr::make_room(Decision& decision, double independence, double now) {
  if (samples_.size() < samples_.capacity()) {
    return true;
  }
  std::size_t least = 0;
  double least_worth = log_worth(0, now);
  for (std::size_t i = 1; i < samples_.size(); ++i) {
    const double worth = log_worth(i, now);
    if (worth < least_worth) {
      least = i;
      least_worth = worth;
    }
  }
  if (std::log(independence) <= least_worth) {
    return false;
  }
  remove(least);
  ++decision.forgotten;
  return true;
}

// ln(δ_i exp(−age²/2h²)): its logarithm, because the weight of old samples underflows.
double SparseOnlineSvr::log_worth(std::size_t i, double now) const {
  const double faded = (now - time_[i]) / settings_.fade_s;
  return std::log(std::max(inverse_.independence(i), settings_.ridge)) - 0.5 * faded * faded;
}

void SparseOnlineSvr::collect(std::span<const double> z, double y, double t) {
  const std::size_t i = samples_.size();
  kernel_.row(z, samples_, row_);  // anew: making room has changed the numbering
  const std::span<const double> row = std::span(row_).first(i);
  inverse_.add(row, 1.0);
  problem_.add(row, 1.0, y);
  samples_.push_back(z);
  time_[i] = t;
  inverse_.keep_exact(problem_.kernel());
}

void SparseOnlineSvr::remove(std::size_t i) {
  inverse_.remove(i);
  Budget endless;
  solver_.release(problem_, i, endless);
  problem_.remove(i);
  solver_.removed(problem_, i);
  samples_.remove(i);
  time_[i] = time_[samples_.size()];
}

void SparseOnlineSvr::train(Decision& decision) {
  solved_ = solver_.solve(problem_);
  decision.iterations = solved_.iterations;
  decision.kkt_gap = solved_.kkt_gap;
  decision.published = solved_.converged;
  if (solved_.converged) {
    model_.assign(samples_, problem_.beta(), problem_.kkt().bias());
    status_.kkt_gap = solved_.kkt_gap;
    status_.ready = true;
  }
}

}  // namespace kelpie::lab
