// SPDX-License-Identifier: Apache-2.0
#include "navigation/practice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

Eigen::Vector2d in_world(const VelocityFilter& filter) {
  return Eigen::Rotation2Dd(filter.mean()(filter.heading())) * filter.mean().head<2>();
}

}  // namespace

void Practice::follow(const VelocityFilter& teacher, std::span<const double> x, double dt_s,
                      bool heard) {
  if (length_s_ == 0.0) {
    return;
  }
  if (!heard || dt_s > kPractice.gap * length_s_) {
    running_ = false;
  } else if (!running_ && !teacher.doubtful()) {
    begin(teacher);
  } else if (running_) {
    go_on(teacher, x, dt_s);
  }
}

void Practice::begin(const VelocityFilter& teacher) {
  pupil_.join(teacher);
  running_ = true;
  age_s_ = 0.0;
  if (pupil_.planar()) {
    pupil_.forget_position();
    way_.setZero();
    before_ = in_world(teacher);
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
    const Eigen::Vector2d now = in_world(teacher);
    way_ += 0.5 * dt_s * (before_ + now);
    before_ = now;
    pupil_.take_yaw_rate(teacher.mean()(2), teacher.covariance()(2, 2));
  }
  if (age_s_ >= length_s_) {
    judge(teacher);
    running_ = false;
  }
}

// The quantile is followed as Robbins and Monro 1951 do.
void Practice::judge(const VelocityFilter& teacher) {
  const Eigen::Index values = pupil_.planar() ? 2 : pupil_.velocities();
  const Eigen::Index first = pupil_.planar() ? pupil_.position() : 0;
  VelocityFilter::Vector off = pupil_.mean().segment(first, values);
  VelocityFilter::Matrix expected = pupil_.covariance().block(first, first, values, values);
  if (pupil_.planar()) {
    off -= way_;
  } else {
    off -= teacher.mean().head(values);
    expected += teacher.covariance().topLeftCorner(values, values);
  }
  const double square = off.dot(VelocityFilter::Vector(expected.ldlt().solve(off)));
  if (std::isfinite(square)) {
    ++judged_;
    error_ += std::max(1.0 / static_cast<double>(judged_), kPractice.share) * (off.norm() - error_);
    const bool outside = square > ninety_percent(values);
    factor_ *= std::exp(kPractice.gain * (outside ? kCoverage : kCoverage - 1.0));
    factor_ = std::clamp(factor_, kPractice.least_factor, kPractice.most_factor);
  }
}

}  // namespace kelpie
