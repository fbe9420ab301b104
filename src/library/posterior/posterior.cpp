// SPDX-License-Identifier: Apache-2.0
#include "posterior/posterior.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/decomposition.hpp"
#include "core/eigen.hpp"
#include "core/vector.hpp"
#include "posterior/tuning.hpp"

namespace kelpie {
namespace {

double weight_of(double surprise, Likelihood likelihood) {
  switch (likelihood) {
    case Likelihood::student:
      return (kPosterior.freedom + 1.0) / (kPosterior.freedom + surprise);
    case Likelihood::huber:
      return std::min(1.0, kPosterior.huber / std::sqrt(surprise));
    case Likelihood::gauss:
      break;
  }
  return 1.0;
}

// Of the prior: terms may explain all of the target's variance, the kernel a third.
double first_precision(std::size_t group) {
  return group == FeatureGroup::kKernel ? kPosterior.kernel_precision : 1.0;
}

}  // namespace

Posterior::Posterior(std::size_t capacity, std::size_t first)
    : seen_(capacity),
      precision_(FeatureGroup::kMost),
      told_(first),
      sums_(capacity),
      factor_(capacity),
      first_(first),
      first_factor_(first),
      first_scale_(first, 1.0) {
  first_factor_.resize(first);
  for (RoomyVector<double>* const numbers :
       {&scale_, &right_, &theta_, &variance_, &weights_, &errors_}) {
    numbers->reserve(capacity);
  }
  scratch_.reserve(2 * capacity);
  clear();
}

void Posterior::clear() {
  seen_.clear();
  weights_.clear();
  errors_.clear();
  widths_at_ = centre_ = served_at_ = 0.0;
  informed_ = noise_ = usual_ = spread_ = 1.0;
  correlation_ = ErrorCorrelation();
  for (std::size_t g = 0; g < FeatureGroup::kMost; ++g) {
    precision_[g] = first_precision(g);
  }
  task_ = Task::none;
  round_ = 0;
}

Posterior::Looks Posterior::look(std::span<const double> phi, double y, double share) {
  if (!ready()) {
    return {};
  }
  const double error = (y - value(*this, phi)) / spread_;
  const double unknown = variance_of_first(phi);
  const double squares = error * error / (noise_ + unknown);
  usual_ += share * (std::min(squares, kPosterior.usual * usual_) - usual_);
  usual_ = std::max(usual_, kPosterior.least_usual);
  return {.surprise = squares / std::max(1.0, usual_),
          .unknown = unknown,
          .noise = noise_,
          .deviations = (y - centre_) / spread_,
          .error = spread_ * std::sqrt(unknown * first_noise_ / noise_)};
}

void Posterior::add(std::span<const double> phi, double y, double trust, Likelihood likelihood) {
  if (seen_.rows >= kPosterior.first_rows && !differ() && y == seen_.origin) {
    return;  // at rest: more of the same would outvote the vehicle that sets off
  }
  double weight = trust;
  if (ready()) {
    const double error = (y - value(*this, phi)) / (spread_ * std::sqrt(noise_));
    correlation_.add(std::clamp(error, -kPosterior.most_deviations, kPosterior.most_deviations));
    weight *= weight_of(look(phi, y).surprise, likelihood);
  }
  seen_.add(phi, y, weight);
}

void Posterior::add(const SampleSums& others, double share) {
  seen_.add(others, first_.size(), share);
  task_ = Task::none;
  round_ = 0;
  widths_at_ = served_at_ = 0.0;
}

double value(const Posterior& posterior, std::span<const double> phi) {
  const std::span<const double> weights = posterior.weights();
  return posterior.centre() + dot(weights, phi.first(weights.size()));
}

// Of the first features' posterior, in variances of the target.
double Posterior::variance_of_first(std::span<const double> phi) {
  scratch_.resize(std::max(scratch_.size(), first_.size()));
  const std::span<double> z{scratch_.data(), first_.size()};
  for (std::size_t i = 0; i < z.size(); ++i) {
    z[i] = phi[i] / first_scale_[i];
  }
  first_factor_.solve_lower(z);
  return dot(std::span<const double>(z), std::span<const double>(z));
}

double Posterior::error(std::size_t feature) const {
  return feature < errors_.size() ? errors_[feature] : std::numeric_limits<double>::infinity();
}

// Targets that never differed tell nothing, and have no unit.
bool Posterior::differ() const {
  return seen_.targets().scale >
         std::max(1e-150, kPosterior.least_deviation * std::abs(seen_.origin));
}

bool Posterior::wants_solve() const {
  const double enough = kPosterior.rows_per_feature * static_cast<double>(seen_.gram.size());
  const bool is_due = seen_.rows >= kPosterior.first_rows && seen_.rows - served_at_ >= enough;
  return task_ != Task::none || (is_due && differ());
}

bool Posterior::solve(std::span<const std::uint8_t> group, Budget& budget) {
  if (task_ == Task::none) {
    begin_solve(group);
  }
  Work left = kPosterior.slice;
  for (std::size_t work = 0; left > 0 && budget.spend(work); left -= static_cast<Work>(work)) {
    work = step(group);
    if (task_ == Task::none) {
      return true;
    }
  }
  return false;
}

void settle(Posterior& posterior, std::span<const std::uint8_t> group) {
  for (Budget all; !posterior.solve(group, all);) {
  }
}

void Posterior::assign_first(const Posterior& other) {
  seen_.clear();
  seen_.add(other.seen_, first_.size(), 1.0);
  correlation_ = other.correlation_;
  precision_ = other.precision_;
  noise_ = other.noise_;
  widths_at_ = 0.0;
  weights_.clear();
}

double Posterior::distance(const Posterior& other) {
  const std::size_t m = weights_.size();
  scratch_.resize(2 * m);
  const std::span<double> difference{scratch_.data(), m};
  const std::span<double> product{scratch_.data() + m, m};
  for (std::size_t i = 0; i < m; ++i) {
    difference[i] = other.weights_[i] - weights_[i];
  }
  difference[0] += other.centre_ - centre_;
  seen_.gram.multiply(difference, product);
  const std::span<const double> known = difference;
  return dot(known, std::span<const double>(product)) / (seen_.weight * noise());
}

// The sums may go on growing while the solve is at hand.
void Posterior::begin_solve(std::span<const std::uint8_t> group) {
  const std::size_t m = seen_.gram.size();
  const TargetScaling targets = seen_.targets();
  const double mean = targets.mean - seen_.origin;
  begun_ = {.rows = seen_.rows,
            .rows_per_sample = std::clamp(correlation_.rows_per_sample(), 1.0,
                                          std::max(1.0, seen_.rows / kPosterior.least_samples)),
            .centre = targets.mean,
            .spread = targets.scale,
            .square = seen_.weight};
  for (RoomyVector<double>* const numbers : {&scale_, &right_, &theta_, &variance_, &scratch_}) {
    numbers->assign(m, 0.0);
  }
  std::ranges::fill(told_, 0.0);
  sums_.resize(m);
  factor_.resize(m);
  const double information = 1.0 / (noise_ * begun_.rows_per_sample);
  for (std::size_t i = 0; i < m; ++i) {
    const double square = seen_.gram.diagonal(i) / seen_.weight;
    // A feature without a value yet keeps the prior.
    scale_[i] = square > std::numeric_limits<double>::min() ? std::sqrt(square) : 1e150;
    right_[i] = (seen_.moment[i] - mean * seen_.gram.row(i)[0]) / (scale_[i] * begun_.spread);
    for (std::size_t j = 0; j <= i; ++j) {
      sums_.row(i)[j] = seen_.gram.row(i)[j] / (scale_[i] * scale_[j]);
      factor_.row(i)[j] = information * sums_.row(i)[j];
    }
    factor_.row(i)[i] += group[i] == FeatureGroup::kFlat ? kPosterior.flat : precision_[group[i]];
  }
  task_ = Task::factorise;
  next_ = 0;
}

// A row of the factor, or a column of its inverse; returns the work.
std::size_t Posterior::step(std::span<const std::uint8_t> group) {
  const std::size_t m = factor_.size();
  const std::size_t done = task_ == Task::factorise ? next_ : m - next_;
  if (task_ == Task::factorise) {
    factor_.factorise_row(next_);
  } else {
    find_variance(next_);
  }
  if (++next_ == m) {
    next_ = 0;
    if (task_ == Task::factorise) {
      find_weights({theta_.data(), m});
      const bool is_due = begun_.rows < kPosterior.young_rows ||
                          begun_.rows >= kPosterior.widths_growth * widths_at_;
      task_ = is_due ? Task::invert : Task::none;
    } else {
      update_widths(group);
      task_ = Task::none;
    }
    if (task_ == Task::none) {
      noise_ = noise_beside({theta_.data(), theta_.size()}, informed_);
      if (begun_.rows < kPosterior.young_rows && ++round_ < kPosterior.young_rounds) {
        begin_solve(group);
      } else {
        round_ = 0;
        serve();
      }
    }
  }
  return done * done / 2;
}

// Of the first theta.size() features.
void Posterior::find_weights(std::span<double> theta) const {
  std::copy_n(right_.begin(), theta.size(), theta.begin());
  factor_.solve_lower(theta);
  factor_.solve_upper(theta);
  for (double& one : theta) {
    one /= noise_ * begun_.rows_per_sample;
  }
}

// Σ_kk = |L⁻¹ e_k|²
void Posterior::find_variance(std::size_t k) {
  const std::size_t m = factor_.size();
  const std::span<double> x{scratch_.data() + k, m - k};
  double square = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const std::span<const double> row = factor_.row(k + i).subspan(k);
    x[i] = ((i == 0 ? 1.0 : 0.0) - dot(row.first(i), x.first(i))) / row[i];
    square += x[i] * x[i];
  }
  variance_[k] = square;
}

void Posterior::update_widths(std::span<const std::uint8_t> group) {
  struct Sums {
    double features = 0.0, trace = 0.0, square = 0.0;
  };
  std::array<Sums, FeatureGroup::kMost> sums{};
  for (std::size_t i = 0; i < theta_.size(); ++i) {
    if (group[i] != FeatureGroup::kFlat) {
      Sums& one = sums.at(group[i]);
      one.features += 1.0;
      one.trace += variance_[i];
      one.square += theta_[i] * theta_[i];
    }
  }
  informed_ = 1.0;
  for (std::size_t g = 0; g < FeatureGroup::kMost; ++g) {
    const double informed = std::max(0.0, sums.at(g).features - precision_[g] * sums.at(g).trace);
    informed_ += informed;
    const bool of_kernel = g == FeatureGroup::kKernel;
    const double weight = of_kernel ? kPosterior.kernel_hyperprior : kPosterior.hyperprior;
    precision_[g] =
        std::clamp((informed + weight) / (sums.at(g).square + weight / first_precision(g)),
                   kPosterior.least_precision, kPosterior.most_precision);
  }
  widths_at_ = begun_.rows;
}

// Errors that fall as weights fit the noise leave fewer samples for its estimate.
double Posterior::noise_beside(std::span<const double> theta, double informed) {
  const std::size_t m = theta.size();
  const std::span<double> product{scratch_.data(), m};
  sums_.multiply(theta, product);
  const double left = begun_.square - 2.0 * dot(theta, {right_.data(), m}) +
                      dot(theta, std::span<const double>(product));
  const double samples = this->samples();
  const double free = std::max(samples - informed, kPosterior.least_freedom * samples);
  return std::clamp(
      (std::max(left, 0.0) / begun_.rows_per_sample + kPosterior.noise_prior) / (free + 1.0),
      kPosterior.least_noise, kPosterior.most_noise);
}

void Posterior::serve() {
  const bool has_variances = widths_at_ == begun_.rows;
  weights_.resize(theta_.size());
  errors_.resize(has_variances ? theta_.size() : std::min(errors_.size(), theta_.size()));
  centre_ = begun_.centre;
  spread_ = begun_.spread;
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    weights_[i] = spread_ * theta_[i] / scale_[i];
    if (has_variances) {
      errors_[i] = spread_ * std::sqrt(variance_[i]) / scale_[i];
    }
  }
  find_weights(first_);
  first_noise_ = noise_beside(first_, static_cast<double>(first_.size()));
  for (std::size_t i = 0; i < first_.size(); ++i) {
    std::ranges::copy(factor_.row(i), first_factor_.row(i).begin());
    first_scale_[i] = scale_[i];
    first_[i] = first_[i] * spread_ / scale_[i] + told_[i];
    weights_[i] += told_[i];
  }
  served_at_ = begun_.rows;
}

void Posterior::tell_anew(std::span<const double> step, std::span<const double> first,
                          double kept) {
  seen_.tell_anew(step);
  if (ready()) {
    weights_.resize(std::max(weights_.size(), step.size()));
    as_vector(weights_).head(static_cast<Eigen::Index>(step.size())) += as_vector(step);
    const auto terms = static_cast<Eigen::Index>(first.size());
    as_vector(first_).head(terms) += as_vector(first);
    as_vector(told_).head(terms) += as_vector(first);
  }
  if (step.size() > first_.size()) {
    // The weights told rest on more than the rows told anew, which the prior would shrink.
    served_at_ = seen_.rows + kPosterior.recalled_rows;
    task_ = Task::none;  // a solve at hand follows steps of the first features only
    round_ = 0;
  }
  fade(kept);
}

void Posterior::fade(double samples) {
  const double share = samples * rows_per_sample() / seen_.rows;
  if (share >= 1.0) {
    return;
  }
  seen_.scale(share);
  widths_at_ *= share;
  task_ = Task::none;  // a solve at hand is of more rows than there are now
  round_ = 0;
  served_at_ = 0.0;
}

void change_functions(RoomyVector<double>& weights, std::size_t first, const Matrix& t) {
  weights.resize(first + t.rows());  // a function that came since has no weight
  const auto map = as_matrix(t);
  const Eigen::MatrixXd square = map.transpose() * map;
  const auto functions = static_cast<Eigen::Index>(t.rows());
  const Eigen::VectorXd right = map.transpose() * as_vector(weights).tail(functions);
  const Eigen::VectorXd changed = solve_symmetric(square, right);
  weights.resize(first);
  weights.insert(weights.end(), changed.begin(), changed.end());
}

void Posterior::change_features(std::size_t first, const Matrix& t) {
  const auto m = static_cast<Eigen::Index>(seen_.gram.size());
  const auto terms = static_cast<Eigen::Index>(first);
  const auto wider = static_cast<Eigen::Index>(t.columns());
  Eigen::MatrixXd map = Eigen::MatrixXd::Zero(m, terms + wider);
  map.topLeftCorner(terms, terms).setIdentity();
  map.bottomRightCorner(m - terms, wider) = as_matrix(t).topRows(m - terms);
  Eigen::MatrixXd gram(m, m);
  for (Eigen::Index i = 0; i < m; ++i) {
    const std::span<const double> row = seen_.gram.row(static_cast<std::size_t>(i));
    for (Eigen::Index j = 0; j <= i; ++j) {
      gram(i, j) = gram(j, i) = row[static_cast<std::size_t>(j)];
    }
  }
  const Eigen::MatrixXd moved = map.transpose() * gram * map;
  const Eigen::VectorXd moment = map.transpose() * as_vector(seen_.moment);
  seen_.gram.resize(static_cast<std::size_t>(moved.rows()));
  seen_.moment.assign(moment.begin(), moment.end());
  for (std::size_t i = 0; i < seen_.gram.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      seen_.gram.row(i)[j] = moved(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    }
  }
  if (ready()) {
    change_functions(weights_, first, t);
  }
  task_ = Task::none;
  errors_.resize(std::min(errors_.size(), first));
  served_at_ = 0.0;
}

std::size_t Posterior::bytes(std::size_t capacity, std::size_t first) {
  return (3 * capacity * (capacity + 1) / 2 + 9 * capacity + first * (first + 1) / 2 + 3 * first +
          FeatureGroup::kMost) *
         sizeof(double);
}

void Posterior::visit(Archive& archive) {
  const auto list = [&](RoomyVector<double>& numbers) {
    archive.list(numbers, numbers.capacity(), [&](double& one) { archive.number(one); });
  };
  archive.part("sums", seen_);
  for (double* const one :
       {&informed_, &noise_, &first_noise_, &usual_, &widths_at_, &centre_, &spread_, &served_at_,
        &begun_.rows, &begun_.rows_per_sample, &begun_.centre, &begun_.spread, &begun_.square}) {
    archive.number(*one);
  }
  archive.part("correlation", correlation_);
  archive.numbers(precision_);
  archive.choice(task_, Task::none, Task::invert);
  archive.whole(round_, 0, kPosterior.young_rounds);
  list(weights_);
  archive.numbers(first_);
  archive.numbers(first_scale_);
  archive.part("factor of the first", first_factor_);
  list(errors_);
  if (task_ != Task::none) {
    archive.numbers(told_);
    archive.part("standardised sums", sums_);
    archive.part("factor", factor_);
    for (RoomyVector<double>* const numbers : {&scale_, &right_, &theta_, &variance_}) {
      list(*numbers);
    }
    archive.whole(next_, 0, factor_.size());
    scratch_.resize(factor_.size());
  }
}

}  // namespace kelpie
