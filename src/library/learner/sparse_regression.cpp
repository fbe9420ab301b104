// SPDX-License-Identifier: Apache-2.0
#include "learner/sparse_regression.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/eigen.hpp"
#include "core/vector.hpp"
#include "learner/tuning.hpp"

namespace kelpie {
namespace {

std::size_t width(const SparseRegressionSettings& settings) {
  return settings.terms + 1 + settings.most_centres;
}

}  // namespace

SparseRegression::SparseRegression(std::size_t inputs, std::size_t terms,
                                   const SparseRegressionSettings& settings)
    : settings_(settings),
      centres_(inputs, settings.most_centres),
      newton_(settings.most_centres * settings.most_centres),
      fit_(width(settings),
           settings.prior_by_noise ? kOnline.members.least_prior : settings.term_prior),
      features_(fit_.terms()),
      kappa_(settings.most_centres),
      beta_(settings.most_centres),
      term_weights_(terms),
      expected_(fit_.terms()),
      information_(fit_.terms(), settings.ridge),
      model_(MixedKernel(settings.gamma, {}, inputs, terms), settings.most_centres) {
  if (settings.prior_by_noise) {
    shrunk_ = fit_;
  }
  clear();
}

std::size_t SparseRegression::bytes(std::size_t inputs, std::size_t terms,
                                    const SparseRegressionSettings& settings) {
  const std::size_t m = width(settings);
  const std::size_t centres = settings.most_centres;
  const std::size_t fits = settings.prior_by_noise ? 2 : 1;
  return (fits * (m * (m + 1) + 5 * m) + 4 * m + centres * centres + 2 * centres + terms) *
             sizeof(double) +
         SampleStore::bytes(inputs, centres) + SvrFunction::bytes(inputs, terms, centres);
}

void SparseRegression::update(std::span<const double> z, double y) {
  learn(z, y);
  publish();
}

void SparseRegression::learn(std::span<const double> z, double y, bool successive) {
  compute_features(z, settings_.new_place);
  const double error = y - as_vector(theta()).dot(as_vector(features_));
  const double root = std::sqrt(weight_of(error));
  if (samples_++ >= kOnline.members.ignored_first) {
    usual_error_.add(error);
    const double most = kOnline.evidence.clip * usual_error_.value();
    if (successive && std::isfinite(most)) {
      correlation_.add(std::clamp(error, -most, most));
    }
  }
  as_vector(features_) *= root;
  fit_.add(features_, root * y);
  known_rows_ += root * root;
}

double SparseRegression::term_error(std::size_t k) const {
  return k < settings_.terms
             ? usual_error_.value() * std::sqrt(correlation_.rows_per_sample() * fit_.variance(k))
             : std::numeric_limits<double>::infinity();
}

void SparseRegression::shift(std::span<const double> step) {
  std::ranges::copy(fit_.theta(), features_.begin());
  for (std::size_t k = 0; k < settings_.terms; ++k) {
    features_[k] += step[k];
  }
  features_[first_centre() - 1] += step.back();
  fit_.set_theta(features_);
  if (shrunk_) {
    add_scaled(1.0, step.first(settings_.terms), std::span(expected_).first(settings_.terms));
    expected_.back() += step.back();
  }
  publish();
}

void SparseRegression::doubt_terms(double samples) {
  const double rows = samples * correlation_.rows_per_sample();
  if (known_rows_ > rows) {
    std::ranges::fill(features_, 1.0);
    std::ranges::fill(std::span(features_).first(first_centre()), std::sqrt(rows / known_rows_));
    fit_.forget(features_);
    known_rows_ = rows;
    publish();
  }
}

void SparseRegression::rescale(std::span<const double> factors, double gain, double offset) {
  correlation_.rescale(gain);
  if (settings_.most_centres > 0) {
    clear();
    return;
  }
  usual_error_.clear();
  if (fit_.rows() == 0) {
    return;
  }
  std::ranges::copy(factors.first(settings_.terms), features_.begin());
  features_[first_centre() - 1] = 1.0;
  fit_.rescale(features_, gain);
  std::ranges::copy(fit_.theta(), features_.begin());
  features_[first_centre() - 1] += offset;
  fit_.set_theta(features_);
  if (shrunk_) {
    for (std::size_t k = 0; k < settings_.terms; ++k) {
      expected_[k] *= gain / factors[k];
    }
    expected_.back() = gain * expected_.back() + offset;
  }
  publish();
}

void SparseRegression::forget_usual_error() {
  usual_error_.clear();
  publish();
}

void SparseRegression::clear() {
  centres_.clear();
  usual_error_.clear();
  samples_ = 0;
  std::ranges::fill(expected_, 0.0);
  std::ranges::fill(std::span(information_).first(first_centre()), 0.0);
  model_.clear();
  forget_samples();
}

void SparseRegression::weaken() {
  std::ranges::copy(fit_.theta(), expected_.begin());
  std::ranges::fill(std::span(information_).first(first_centre()), settings_.term_prior);
  usual_error_.clear();
  samples_ = 0;
  forget_samples();
}

void SparseRegression::expect(std::span<const double> weights, double samples) {
  clear();
  std::ranges::copy(weights.first(settings_.terms), expected_.begin());
  expected_[first_centre() - 1] = weights.back();
  std::ranges::fill(std::span(information_).first(first_centre()), samples);
  forget_samples();
}

void SparseRegression::start_over() {
  samples_ = kOnline.members.ignored_first;
  forget_samples();
}

void SparseRegression::forget_samples() {
  fit_.set_prior(expected_, information_);
  known_rows_ = 0.0;
  publish();
}

void SparseRegression::imitate(const SvrFunction& function, const SampleStore& places) {
  clear();
  std::vector<double> z(places.dimension());
  const double root = std::sqrt(kOnline.members.imitated / static_cast<double>(places.size()));
  const std::size_t known = function.support_vectors().size();
  const bool alike = function.kernel().local().gamma() == settings_.gamma;
  for (std::size_t i = 0; i < places.size(); ++i) {
    places.get(i, z);
    compute_features(z, !alike ? settings_.new_place : i < known ? 0.0 : 1.0);
    as_vector(features_) *= root;
    fit_.add(features_, root * function(z));
  }
  known_rows_ = kOnline.members.imitated;
  if (alike && centres_.size() == known) {
    set_coefficients(function);
  }
  if (shrunk_) {
    std::ranges::copy(fit_.theta(), expected_.begin());
  }
  publish();
}

// θ_v = Lᵀ β
void SparseRegression::set_coefficients(const SvrFunction& function) {
  const std::span<const double> beta = function.beta();
  std::ranges::fill(features_, 0.0);
  std::copy_n(function.term_weights().begin(), settings_.terms, features_.begin());
  features_[first_centre() - 1] = function.bias();
  for (std::size_t j = 0; j < beta.size(); ++j) {
    add_scaled(beta[j], newton_row(j), newton().first(j + 1));
  }
  fit_.set_theta(features_);
}

void SparseRegression::visit(Archive& archive) {
  archive.part("centres", centres_);
  for (std::size_t j = 0; j < centres_.size(); ++j) {
    archive.numbers({newton_.data() + j * settings_.most_centres, j + 1});
  }
  archive.part("fit", fit_);
  archive.numbers(expected_);
  archive.numbers(information_);
  archive.part("usual error", usual_error_);
  archive.part("correlation", correlation_);
  archive.number(known_rows_);
  archive.whole(samples_);
  if (archive.loading()) {
    for (std::size_t j = 0; j < centres_.size(); ++j) {
      archive.require(newton_row(j).back() > 0.0, "holds centres that tell the same");
    }
    publish();
  }
}

// The features of a sample, which becomes a centre where more than `new_place` of it is new.
void SparseRegression::compute_features(std::span<const double> z, double new_place) {
  std::ranges::fill(features_, 0.0);
  std::ranges::copy(z.subspan(centres_.dimension(), settings_.terms), features_.begin());
  features_[first_centre() - 1] = 1.0;
  if (settings_.most_centres == 0) {
    return;
  }
  const std::span<const double> place = z.first(centres_.dimension());
  model_.kernel().local().row(place, centres_, kappa_);
  const std::span<double> v = newton();
  double left = 1.0;
  for (std::size_t j = 0; j < v.size(); ++j) {
    const std::span<const double> row = newton_row(j);
    v[j] = (kappa_[j] - dot(row.first(j), v.first(j))) / row[j];
    left -= v[j] * v[j];
  }
  if (left > new_place && centres_.size() < settings_.most_centres) {
    add_centre(place, left);
  }
}

void SparseRegression::add_centre(std::span<const double> z, double left) {
  const std::span<const double> v = newton();
  double* const row = newton_.data() + centres_.size() * settings_.most_centres;
  std::ranges::copy(v, row);
  row[v.size()] = std::sqrt(left);
  centres_.push_back(z);
  newton().back() = std::sqrt(left);
}

double SparseRegression::weight_of(double error) const {
  const double share = usual_error_.huber_weight(error, kOnline.members.huber);
  return share * share;
}

double SparseRegression::prior_samples() const {
  const double noise = usual_error_.value();
  return std::min(settings_.term_prior, noise * noise * correlation_.rows_per_sample());
}

// The function of θ in its usual basis: β = L⁻ᵀ θ_v.
void SparseRegression::publish() {
  if (shrunk_) {
    *shrunk_ = fit_;
    shrunk_->hold(expected_, prior_samples());
  }
  const std::span<const double> theta = this->theta();
  std::copy_n(theta.begin(), settings_.terms, term_weights_.begin());
  const std::span<double> beta = std::span(beta_).first(centres_.size());
  std::copy_n(theta.data() + first_centre(), beta.size(), beta.begin());
  for (std::size_t j = beta.size(); j-- > 0;) {
    const std::span<const double> row = newton_row(j);
    beta[j] /= row[j];
    add_scaled(-beta[j], row.first(j), beta.first(j));
  }
  model_.assign(centres_, beta, term_weights_, theta[first_centre() - 1]);
}

}  // namespace kelpie
