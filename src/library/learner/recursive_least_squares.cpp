// SPDX-License-Identifier: Apache-2.0
#include "kelpie/learner/recursive_least_squares.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/eigen.hpp"
#include "core/quantile.hpp"
#include "kelpie/motion/term_set.hpp"
#include "learner/triangular_fit.hpp"
#include "learner/tuning.hpp"

namespace kelpie {
namespace {

using RlsSettings = RecursiveLeastSquaresSettings;

constexpr std::array kOwnSettings = std::to_array<Setting<RlsSettings>>({
    {"velocities",
     "how many of the inputs, the first ones, are velocities; the rest are thruster speeds",
     &RlsSettings::velocities,
     {.low = 1.0, .high = kOnline.least_squares.most_velocities}},
    {"lambda",
     "λ: weight of a sample against the one that came after it; 1 forgets nothing",
     &RlsSettings::lambda,
     {.low = 0.5, .high = 1.0}},
    {"huber",
     "usual errors beyond which a sample counts less; 0: all count whole",
     &RlsSettings::huber,
     {.low = 0}},
    {"prior",
     "ρ: the least that is known of a coefficient, in samples of its term's usual size",
     &RlsSettings::prior,
     {.low = 1e-12, .high = 1.0}},
});

TermSet fossen_terms(std::span<const std::string> inputs, const RlsSettings& settings) {
  settings.validate();
  const auto velocities = static_cast<std::size_t>(settings.velocities);
  if (inputs.size() < velocities || inputs.size() > kMostInputs) {
    throw InputError("inputs", std::to_string(inputs.size()) + " given; there have to be " +
                                   std::to_string(velocities) + " velocities and up to " +
                                   std::to_string(kMostInputs - velocities) + " thruster speeds");
  }
  return TermSet::from("fossen", inputs, velocities);
}

}  // namespace

std::span<const Setting<RecursiveLeastSquaresSettings>> recursive_least_squares_fields() {
  return kOwnSettings;
}

void RecursiveLeastSquaresSettings::validate() const {
  for (const Setting<RlsSettings>& field : kOwnSettings) {
    field.check(*this);
  }
}

RecursiveLeastSquares::RecursiveLeastSquares(std::span<const std::string> inputs,
                                             const RlsSettings& settings)
    : RecursiveLeastSquares(inputs.size(), fossen_terms(inputs, settings), settings) {}

RecursiveLeastSquares::RecursiveLeastSquares(std::size_t inputs, TermSet terms,
                                             const RlsSettings& settings)
    : settings_(settings),
      inputs_(inputs),
      terms_(std::move(terms)),
      fit_(std::make_unique<TriangularFit>(terms_.size() + 1, settings.prior)),
      keep_(fit_->terms(), std::sqrt(settings.lambda)) {
  settings.validate();
}

RecursiveLeastSquares::RecursiveLeastSquares(RecursiveLeastSquares&&) noexcept = default;
RecursiveLeastSquares& RecursiveLeastSquares::operator=(RecursiveLeastSquares&&) noexcept = default;
RecursiveLeastSquares::~RecursiveLeastSquares() = default;

std::span<const double> RecursiveLeastSquares::estimates() const {
  return fit_->theta();
}

Decision RecursiveLeastSquares::update(std::span<const double> x, double y, double t) {
  Decision decision{.had_model = status_.ready};
  Terms phi;
  if (x.size() == inputs_) {
    phi = terms(x);
  }
  if (phi.size() == 0 || !std::isfinite(as_vector(phi).squaredNorm() + y * y) ||
      !std::isfinite(t)) {
    decision.verdict = Verdict::invalid;
    decision.prediction.value = std::numeric_limits<double>::quiet_NaN();
    status_.tally.add(decision);
    return decision;
  }
  decision.prediction.value = as_vector(estimates()).dot(as_vector(phi));
  const double error = y - decision.prediction.value;
  const double root = std::sqrt(weight_of(error));
  errors_[static_cast<std::size_t>(samples_++) % kWindow] = std::abs(error);

  forget();
  as_vector(phi) *= root;
  fit_->add(as_span(phi), root * y);
  decision.published = status_.ready = true;
  status_.tally.add(decision);
  return decision;
}

double RecursiveLeastSquares::predict(std::span<const double> x) const {
  const Terms phi = terms(x);
  return as_vector(estimates()).dot(as_vector(phi));
}

// Not by TermSet::evaluate: a term that overflows has to be seen.
RecursiveLeastSquares::Terms RecursiveLeastSquares::terms(std::span<const double> x) const {
  Terms phi(fit_->terms());
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    phi[k] = terms_.term(k)(x);
  }
  phi[fit_->terms() - 1] = 1.0;
  return phi;
}

std::vector<double> RecursiveLeastSquares::variances() const {
  std::vector<double> variances(fit_->terms());
  for (std::size_t k = 0; k < fit_->terms(); ++k) {
    variances[k] = fit_->variance(k);
  }
  return variances;
}

double RecursiveLeastSquares::weight_of(double error) const {
  if (settings_.huber == 0.0 || samples_ < static_cast<std::int64_t>(kWindow)) {
    return 1.0;
  }
  std::array<double, kWindow> sorted = errors_;
  const double most = settings_.huber * kSigmaPerMedian * quantile(sorted, 0.5);
  return std::abs(error) > most ? most / std::abs(error) : 1.0;
}

// √λ everywhere is exponential forgetting; a 1 keeps what is known of a term.
void RecursiveLeastSquares::forget() {
  if (settings_.lambda == 1.0) {
    return;
  }
  if (samples_ % kOnline.least_squares.weak_look_every == 0) {
    find_weak_terms();
  }
  fit_->forget(keep_);
}

void RecursiveLeastSquares::find_weak_terms() {
  const double bound = 1.0 / settings_.prior;
  for (std::size_t k = 0; k < fit_->terms(); ++k) {
    const bool weak = fit_->variance(k) * fit_->moments()[k] > bound;
    keep_[k] = weak ? 1.0 : std::sqrt(settings_.lambda);
  }
}

}  // namespace kelpie
