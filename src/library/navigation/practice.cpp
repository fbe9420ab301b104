// SPDX-License-Identifier: Apache-2.0
#include "navigation/practice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/quantile.hpp"
#include "navigation/tuning.hpp"

namespace kelpie {
namespace {

constexpr const auto& kPractice = kNavigationTuning.practice;

constexpr double kCoverage = 0.9;
constexpr double kLeastSquare = 1e-12;  // of an error, against the logarithm of 0

// What a sum of so many squared standard normal values stays below in nine of ten cases (Wilson and
// Hilferty 1931).
double ninety_percent(Eigen::Index values) {
  constexpr double kNormal = 1.2816;
  const double share = 2.0 / (9.0 * static_cast<double>(values));
  return static_cast<double>(values) * std::pow(1.0 - share + kNormal * std::sqrt(share), 3.0);
}

bool is_doubtful(const VelocityFilter& filter) {
  bool found = false;
  for (Eigen::Index i = 0; i < filter.velocities(); ++i) {
    found = found || filter.doubtful(i);
  }
  return found;
}

}  // namespace

Practice::Practice(const VelocityFilter& filter, double length_s)
    : pupil_(filter),
      scored_(filter.velocities()),
      length_s_(length_s),
      as_heard_(filter.model().seen.size()),
      sizes_{RecentValues(kPractice.outages), RecentValues(kPractice.outages),
             RecentValues(kPractice.outages)},
      speeds_(sizes_) {
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < filter.velocities(); ++i) {
    if (filter.planar() ? i < 2 : filter.is_of_log(i)) {
      scored_(count++) = i;
    }
  }
  scored_.conservativeResize(count);
}

double Practice::age_to_score(std::size_t i) const {
  return length_s_ * std::array{kPractice.early, 1.0, kPractice.longer}[i];
}

Eigen::Vector2d Practice::in_world(const VelocityFilter& teacher, std::span<const double> x) const {
  const std::vector<std::size_t>& states = pupil_.model().states;
  return Eigen::Rotation2Dd(teacher.mean()(teacher.heading())) *
         Eigen::Vector2d(x[states[0]], x[states[1]]);
}

void Practice::follow(const VelocityFilter& teacher, std::span<const double> x, double dt_s,
                      bool heard, bool lost) {
  if (length_s_ == 0.0 || scored_.size() == 0) {
    return;
  }
  if (lost || dt_s > kPractice.gap * length_s_) {
    running_ = false;
  } else if (running_) {
    go_on(teacher, x, dt_s, heard);
  } else if (heard && !is_doubtful(teacher)) {
    begin(teacher, x);
  }
}

void Practice::begin(const VelocityFilter& teacher, std::span<const double> x) {
  pupil_.join(teacher);
  running_ = true;
  ++begun_;
  age_s_ = 0.0;
  heard_s_ = 0.0;
  next_ = 0;
  if (pupil_.planar()) {
    pupil_.forget_position();
    way_.setZero();
    way_variance_ = 0.0;
    before_ = in_world(teacher, x);
  }
}

void Practice::go_on(const VelocityFilter& teacher, std::span<const double> x, double dt_s,
                     bool heard) {
  as_heard_.assign(x.begin(), x.end());
  for (Eigen::Index i = 0; i < pupil_.velocities(); ++i) {
    if (pupil_.is_of_log(i)) {
      as_heard_[pupil_.model().states[static_cast<std::size_t>(i)]] =
          std::numeric_limits<double>::quiet_NaN();
    }
  }
  pupil_.predict(as_heard_, dt_s, factor_);
  take_rates(x);
  age_s_ += dt_s;
  if (pupil_.planar()) {
    pupil_.take(2, teacher.mean()(2), teacher.covariance()(2, 2));
  }
  if (!heard) {
    return;
  }
  const double step_s = age_s_ - std::exchange(heard_s_, age_s_);
  if (pupil_.planar()) {
    const Eigen::Vector2d now = in_world(teacher, x);
    const std::vector<double>& noise = pupil_.model().noise;
    way_ += 0.5 * step_s * (before_ + now);
    way_variance_ += 0.5 * step_s * step_s * (noise[0] * noise[0] + noise[1] * noise[1]);
    before_ = now;
  }
  if (age_s_ >= age_to_score(next_)) {
    judge(teacher, x);
    ++next_;
    running_ = next_ < (begun_ % kPractice.every == 0 ? kAges : kAges - 1);
  }
}

// Of gyros, which an outage of the log leaves; the yaw rate of planar motion is the teacher's.
void Practice::take_rates(std::span<const double> x) {
  for (Eigen::Index i = 0; i < pupil_.velocities(); ++i) {
    const auto state = static_cast<std::size_t>(i);
    const double value = x[pupil_.model().states[state]];
    if (!pupil_.is_of_log(i) && (!pupil_.planar() || i != 2) && std::isfinite(value)) {
      const double noise = pupil_.model().noise[state];
      pupil_.correct(std::array{i}, VelocityFilter::Vector::Constant(1, value),
                     VelocityFilter::Matrix::Constant(
                         1, 1, std::max(noise * noise, kNavigationTuning.choice.least_noise)));
    }
  }
}

// The largest of so few errors that conformal prediction promises less than nine in ten is taken no
// smaller than the bound of Gaussian errors in the plane, whose variance these errors tell: the
// quantile of Fisher's F with 2 and 2n degrees of freedom is n (10^(1/n) - 1) (Hotelling 1931).
double Practice::bound_of(const RecentValues& sizes) const {
  std::array<double, kPractice.outages> recent{};
  const std::span<double> values = sizes.copy_to(recent);
  double bound = conformal_bound(values, kCoverage);
  const auto n = static_cast<double>(values.size());
  if (n < kCoverage / (1.0 - kCoverage)) {
    const double squares = std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
    bound = std::max(bound, std::sqrt(squares * (std::pow(10.0, 1.0 / n) - 1.0)));
  }
  return bound / std::sqrt(factor_);
}

double Practice::factor_at(const Sizes& sizes, double age_s) const {
  double before_age_s = 0.0;
  double before = 1.0;
  for (std::size_t i = 0; i < kAges; ++i) {
    if (sizes[i].size() < kPractice.least) {
      continue;
    }
    const double bound = bound_of(sizes[i]);
    const double age = age_to_score(i);
    if (age_s <= age) {
      const double share = before_age_s > 0.0
                               ? std::log(age_s / before_age_s) / std::log(age / before_age_s)
                               : age_s / age;
      return before + share * (bound - before);
    }
    before_age_s = age;
    before = bound;
  }
  return before;
}

// The factor is followed as Robbins and Monro 1951 do.
void Practice::judge(const VelocityFilter& teacher, std::span<const double> x) {
  const Eigen::Index values = scored_.size();
  VelocityFilter::Vector off(values);
  VelocityFilter::Matrix expected(values, values);
  double noise = way_variance_;
  if (pupil_.planar()) {
    const Eigen::Index first = pupil_.position();
    off = pupil_.mean().segment(first, values) - way_;
    expected = pupil_.covariance().block(first, first, values, values);
    expected.diagonal().array() += way_variance_;
  } else {
    off = pupil_.mean()(scored_) - teacher.mean()(scored_);
    noise = teacher.covariance()(scored_, scored_).trace();
    expected = pupil_.covariance()(scored_, scored_) + teacher.covariance()(scored_, scored_);
  }
  const double square = off.dot(VelocityFilter::Vector(expected.ldlt().solve(off)));
  if (!std::isfinite(square)) {
    return;
  }
  const double edge = ninety_percent(values);
  sizes_[next_].add(std::sqrt(std::max(square, 0.0) / edge * factor_));
  judge_velocities(x);
  if (next_ == 1) {
    ++judged_;
    const double share = std::max(1.0 / static_cast<double>(judged_), kPractice.share);
    log_error_ += share * (0.5 * std::log(off.squaredNorm() + noise + kLeastSquare) - log_error_);
    factor_ *= std::exp(kPractice.gain * (square > edge ? kCoverage : kCoverage - 1.0));
    factor_ = std::clamp(factor_, kPractice.least_factor, kPractice.most_factor);
  }
}

void Practice::judge_velocities(std::span<const double> x) {
  const Eigen::Index values = scored_.size();
  VelocityFilter::Vector off = pupil_.mean()(scored_);
  VelocityFilter::Matrix expected = pupil_.covariance()(scored_, scored_);
  for (Eigen::Index i = 0; i < values; ++i) {
    const auto state = static_cast<std::size_t>(scored_(i));
    off(i) -= x[pupil_.model().states[state]];
    expected(i, i) += pupil_.model().noise[state] * pupil_.model().noise[state];
  }
  const double square = off.dot(VelocityFilter::Vector(expected.ldlt().solve(off)));
  if (std::isfinite(square)) {
    speeds_[next_].add(std::sqrt(std::max(square, 0.0) / ninety_percent(values) * factor_));
  }
}

}  // namespace kelpie
