// SPDX-License-Identifier: Apache-2.0
#include "navigation/practice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/quantile.hpp"
#include "navigation/tuning.hpp"

namespace kelpie {
namespace {

constexpr const auto& kPractice = kNavigationTuning.practice;

constexpr double kCoverage = 0.9;

// What a sum of so many squared standard normal values stays below in nine of ten cases (Wilson and
// Hilferty 1931).
double ninety_percent(Eigen::Index values) {
  constexpr double kNormal = 1.2816;
  const double share = 2.0 / (9.0 * static_cast<double>(values));
  return static_cast<double>(values) * std::pow(1.0 - share + kNormal * std::sqrt(share), 3.0);
}

}  // namespace

Practice::Practice(const VelocityFilter& filter, double length_s)
    : pupil_(filter),
      length_s_(length_s),
      as_heard_(filter.model().seen.size()),
      sizes_{RecentValues(kPractice.outages), RecentValues(kPractice.outages),
             RecentValues(kPractice.outages)} {}

double Practice::age_to_score(std::size_t i) const {
  return length_s_ * std::array{kPractice.early, 1.0, kPractice.longer}[i];
}

Eigen::Vector2d Practice::in_world(const VelocityFilter& teacher, std::span<const double> x) const {
  const std::vector<std::size_t>& states = pupil_.model().states;
  return Eigen::Rotation2Dd(teacher.mean()(teacher.heading())) *
         Eigen::Vector2d(x[states[0]], x[states[1]]);
}

void Practice::follow(const VelocityFilter& teacher, std::span<const double> x, double dt_s,
                      bool heard) {
  if (length_s_ == 0.0) {
    return;
  }
  if (!heard || dt_s > kPractice.gap * length_s_) {
    running_ = false;
  } else if (!running_ && !teacher.doubtful()) {
    begin(teacher, x);
  } else if (running_) {
    go_on(teacher, x, dt_s);
  }
}

void Practice::begin(const VelocityFilter& teacher, std::span<const double> x) {
  pupil_.join(teacher);
  running_ = true;
  ++begun_;
  age_s_ = 0.0;
  next_ = 0;
  if (pupil_.planar()) {
    pupil_.forget_position();
    way_.setZero();
    way_variance_ = 0.0;
    before_ = in_world(teacher, x);
  }
}

void Practice::go_on(const VelocityFilter& teacher, std::span<const double> x, double dt_s) {
  as_heard_.assign(x.begin(), x.end());
  for (Eigen::Index i = 0; i < pupil_.velocities(); ++i) {
    if (!pupil_.planar() || i != 2) {
      as_heard_[pupil_.model().states[static_cast<std::size_t>(i)]] =
          std::numeric_limits<double>::quiet_NaN();
    }
  }
  pupil_.predict(as_heard_, dt_s, factor_);
  age_s_ += dt_s;
  if (pupil_.planar()) {
    const Eigen::Vector2d now = in_world(teacher, x);
    const std::vector<double>& noise = pupil_.model().noise;
    way_ += 0.5 * dt_s * (before_ + now);
    way_variance_ += 0.5 * dt_s * dt_s * (noise[0] * noise[0] + noise[1] * noise[1]);
    before_ = now;
    pupil_.take_yaw_rate(teacher.mean()(2), teacher.covariance()(2, 2));
  }
  if (age_s_ >= age_to_score(next_)) {
    judge(teacher);
    ++next_;
    running_ = next_ < (begun_ % kPractice.every == 0 ? kAges : kAges - 1);
  }
}

double Practice::widening(double age_s) const {
  double before_age_s = 0.0;
  double before = 1.0;
  for (std::size_t i = 0; i < kAges; ++i) {
    if (sizes_[i].size() < kPractice.least) {
      continue;
    }
    std::array<double, kPractice.outages> sizes{};
    const double bound = conformal_bound(sizes_[i].copy_to(sizes), kCoverage);
    const double age = age_to_score(i);
    if (age_s <= age) {
      const double share =
          before_age_s > 0.0 ? std::log(age_s / before_age_s) / std::log(age / before_age_s) : 1.0;
      return before + share * (bound - before);
    }
    before_age_s = age;
    before = bound;
  }
  return before;
}

// The factor is followed as Robbins and Monro 1951 do.
void Practice::judge(const VelocityFilter& teacher) {
  const Eigen::Index values = pupil_.planar() ? 2 : pupil_.velocities();
  const Eigen::Index first = pupil_.planar() ? pupil_.position() : 0;
  VelocityFilter::Vector off = pupil_.mean().segment(first, values);
  VelocityFilter::Matrix expected = pupil_.covariance().block(first, first, values, values);
  if (pupil_.planar()) {
    off -= way_;
    expected.diagonal().array() += way_variance_;
  } else {
    off -= teacher.mean().head(values);
    expected += teacher.covariance().topLeftCorner(values, values);
  }
  const double square = off.dot(VelocityFilter::Vector(expected.ldlt().solve(off)));
  if (!std::isfinite(square)) {
    return;
  }
  const double edge = ninety_percent(values);
  sizes_[next_].add(std::sqrt(std::max(square, 0.0) / edge));
  if (next_ == 1) {
    ++judged_;
    error_ += std::max(1.0 / static_cast<double>(judged_), kPractice.share) * (off.norm() - error_);
    factor_ *= std::exp(kPractice.gain * (square > edge ? kCoverage : kCoverage - 1.0));
    factor_ = std::clamp(factor_, kPractice.least_factor, kPractice.most_factor);
  }
}

}  // namespace kelpie
