// SPDX-License-Identifier: Apache-2.0
#include "kelpie/baseline/recursive_least_squares.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "kelpie/core/quantile.hpp"
#include "kelpie/core/scaling.hpp"

namespace kelpie {
namespace {

using S = RecursiveLeastSquaresSettings;

constexpr std::int64_t kLookEvery = 16;  // samples between two looks for weakly known terms
constexpr double kNormalMad = 1.4826;    // standard deviation over median |e| of a Gaussian

constexpr std::array kFields = std::to_array<Setting<S>>({
    {"velocities",
     "how many of the inputs, the first ones, are velocities; the rest are thruster speeds",
     &S::velocities,
     {.low = 1.0, .high = FossenTerms::kMostVelocities}},
    {"lambda",
     "λ: weight of a sample against the one that came after it; 1 forgets nothing",
     &S::lambda,
     {.low = 0.5, .high = 1.0}},
    {"huber", "a residual counts up to this many usual errors; 0: as it is", &S::huber, {.low = 0}},
    {"prior",
     "ρ: the least that is known of a coefficient, in samples of its term's usual size",
     &S::prior,
     {.low = 1e-12, .high = 1.0}},
});

std::size_t thrusters(std::size_t inputs, const S& settings) {
  settings.validate();
  const auto velocities = static_cast<std::size_t>(settings.velocities);
  if (inputs < velocities || inputs > kMostInputs) {
    throw InputError({.file = {}, .line = 0, .field = "inputs"},
                     std::to_string(inputs) + " given; there have to be " +
                         std::to_string(velocities) + " velocities and up to " +
                         std::to_string(kMostInputs - velocities) + " thruster speeds");
  }
  return inputs - velocities;
}

}  // namespace

std::span<const Setting<RecursiveLeastSquaresSettings>> recursive_least_squares_fields() {
  return kFields;
}

void RecursiveLeastSquaresSettings::validate() const {
  for (const Setting<S>& field : kFields) {
    field.check(*this);
  }
}

RecursiveLeastSquares::RecursiveLeastSquares(std::size_t inputs, const S& settings)
    : settings_(settings),
      terms_(static_cast<std::size_t>(settings.velocities), thrusters(inputs, settings)) {
  const auto m = static_cast<Eigen::Index>(terms_.size());
  factor_ = Factor::Zero(m, m + 1);
  row_ = Eigen::RowVectorXd::Zero(m + 1);
  theta_ = Eigen::VectorXd::Zero(m);
  moment_ = Eigen::VectorXd::Zero(m);
  prior_ = Eigen::VectorXd::Zero(m);
  keep_ = Eigen::VectorXd::Constant(m, std::sqrt(settings_.lambda));
  scratch_ = Eigen::VectorXd::Zero(m);
}

Decision RecursiveLeastSquares::update(std::span<const double> x, double y, double t) {
  Decision decision{.had_model = status_.ready};
  FossenTerms::Values phi;
  if (x.size() == terms_.inputs()) {
    phi = terms_(x);
  }
  if (phi.size() == 0 || !std::isfinite(phi.squaredNorm() + y * y) || !std::isfinite(t)) {
    decision.verdict = Verdict::invalid;
    ++status_.tally.invalid;
    return decision;
  }
  decision.predicted = theta_.dot(phi);
  const double error = y - decision.predicted;
  const double counted = clipped(error);
  errors_[static_cast<std::size_t>(samples_++) % kWindow] = std::abs(error);

  forget();
  add_priors(phi);
  row_ << phi.transpose(), decision.predicted + counted;
  absorb();
  solve();
  decision.served = status_.ready = true;
  ++status_.tally.accepted;
  return decision;
}

double RecursiveLeastSquares::predict(std::span<const double> x) const {
  return theta_.dot(terms_(x));
}

Eigen::VectorXd RecursiveLeastSquares::variances() const {
  Eigen::VectorXd scratch(theta_.size());
  Eigen::VectorXd variances(theta_.size());
  for (Eigen::Index k = 0; k < theta_.size(); ++k) {
    variances(k) = variance(k, scratch);
  }
  return variances;
}

double RecursiveLeastSquares::clipped(double error) const {
  if (settings_.huber == 0.0 || samples_ < static_cast<std::int64_t>(kWindow)) {
    return error;
  }
  std::array<double, kWindow> sorted = errors_;
  const double most = settings_.huber * kNormalMad * quantile(sorted, 0.5);
  return std::clamp(error, -most, most);
}

// P → D⁻¹PD⁻¹ with D = diag(keep): √λ everywhere is exponential forgetting; a 1 keeps what is known
// of a term. θ stays in either case.
void RecursiveLeastSquares::forget() {
  if (settings_.lambda == 1.0) {
    return;
  }
  if (samples_ % kLookEvery == 0) {
    find_weak_terms();
  }
  const Eigen::Index m = theta_.size();
  for (Eigen::Index k = 0; k < m; ++k) {
    auto kept = factor_.row(k).segment(k, m - k);
    kept.array() *= keep_.tail(m - k).transpose().array();
    factor_(k, m) = kept.dot(theta_.tail(m - k));
  }
}

void RecursiveLeastSquares::find_weak_terms() {
  const double bound = 1.0 / settings_.prior;
  for (Eigen::Index k = 0; k < theta_.size(); ++k) {
    const bool weak = variance(k, scratch_) * moment_(k) > bound;
    keep_(k) = weak ? 1.0 : std::sqrt(settings_.lambda);
  }
}

void RecursiveLeastSquares::add_priors(const FossenTerms::Values& phi) {
  moment_ += (phi.cwiseAbs2() - moment_) / static_cast<double>(samples_);
  for (Eigen::Index k = 0; k < theta_.size(); ++k) {
    const double wanted = settings_.prior * moment_(k);
    if (wanted > 0.0 && wanted >= 2.0 * prior_(k)) {
      row_.setZero();
      row_(k) = std::sqrt(wanted - prior_(k));
      prior_(k) = wanted;
      absorb();
    }
  }
}

// Rotates row_ into the factor.
void RecursiveLeastSquares::absorb() {
  const Eigen::Index m = theta_.size();
  for (Eigen::Index k = 0; k < m; ++k) {
    if (row_(k) == 0.0) {
      continue;
    }
    const double length = std::hypot(factor_(k, k), row_(k));
    const double cosine = factor_(k, k) / length;
    const double sine = row_(k) / length;
    for (Eigen::Index j = k; j <= m; ++j) {
      const double above = factor_(k, j);
      factor_(k, j) = cosine * above + sine * row_(j);
      row_(j) = cosine * row_(j) - sine * above;
    }
    row_(k) = 0.0;
  }
}

void RecursiveLeastSquares::solve() {
  const Eigen::Index m = theta_.size();
  for (Eigen::Index k = m - 1; k >= 0; --k) {
    const Eigen::Index rest = m - 1 - k;
    const double known = factor_.row(k).segment(k + 1, rest).dot(theta_.tail(rest));
    theta_(k) = factor_(k, k) > 0.0 ? (factor_(k, m) - known) / factor_(k, k) : 0.0;
  }
}

// P_kk = |R⁻ᵀ e_k|², by forward substitution.
double RecursiveLeastSquares::variance(Eigen::Index k, Eigen::VectorXd& scratch) const {
  if (!(factor_(k, k) > 0.0)) {
    return std::numeric_limits<double>::infinity();
  }
  scratch(k) = 1.0 / factor_(k, k);
  double square = scratch(k) * scratch(k);
  for (Eigen::Index j = k + 1; j < theta_.size(); ++j) {
    const Eigen::Index between = j - k;
    const double sum = factor_.col(j).segment(k, between).dot(scratch.segment(k, between));
    scratch(j) = factor_(j, j) > 0.0 ? -sum / factor_(j, j) : 0.0;
    square += scratch(j) * scratch(j);
  }
  return square;
}

}  // namespace kelpie
