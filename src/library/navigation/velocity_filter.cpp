// SPDX-License-Identifier: Apache-2.0
#include "navigation/velocity_filter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "model/seen_velocities.hpp"
#include "navigation/tuning.hpp"

namespace kelpie {
namespace {

constexpr const auto& kFilter = kNavigationTuning.filter;

// A B, compiled once: the compiler expands a product of such matrices wherever one is written.
VelocityFilter::Matrix product(const VelocityFilter::Matrix& a, const VelocityFilter::Matrix& b) {
  return a * b;
}

}  // namespace

VelocityFilter::VelocityFilter(const OpenLoop& model, const DeadReckoningSettings& settings)
    : model_(model),
      step_s_(settings.step_s),
      current_m_s_(settings.current_m_s),
      current_wander_(settings.current_wander),
      between_(settings.between),
      velocities_(static_cast<Eigen::Index>(model.states.size())),
      planar_(settings.planar),
      mean_(Vector::Zero(2 * velocities_ + (planar_ ? kPlanar : 0))),
      covariance_(Matrix::Zero(mean_.size(), mean_.size())),
      doubted_(Vector::Constant(mean_.size(), std::numeric_limits<double>::quiet_NaN())),
      from_(model.seen.size()),
      to_(from_),
      at_(from_) {
  of_log_.fill(true);
  of_log_[2] = !planar_;
  for (const std::size_t rate : settings.rates) {
    of_log_[rate] = false;
  }
}

void VelocityFilter::start(std::span<const double> x, const Matrix& noise) {
  from_.assign(x.begin(), x.end());
  to_ = from_;
  mean_.setZero();
  covariance_.setZero();
  doubts_.fill(0);
  doubted_.setConstant(std::numeric_limits<double>::quiet_NaN());
  covariance_.topLeftCorner(velocities_, velocities_) = noise;
  for (Eigen::Index i = 0; i < velocities_; ++i) {
    const auto state = static_cast<std::size_t>(i);
    mean_(i) = x[model_.states[state]];
    covariance_(velocities_ + i, velocities_ + i) = model_.error[state] * model_.error[state];
  }
  if (planar_) {
    covariance_.diagonal().segment(current(), 2).setConstant(current_m_s_ * current_m_s_);
  }
}

void VelocityFilter::join(const VelocityFilter& other) {
  mean_ = other.mean_;
  covariance_ = other.covariance_;
  doubts_ = other.doubts_;
  doubted_ = other.doubted_;
  to_ = other.to_;
  for (const std::size_t state : model_.states) {
    model_.seen[state] = other.model_.seen[state];
  }
}

void VelocityFilter::use(const OpenLoop& model) {
  const std::vector<Extremes> seen = model_.seen;
  model_ = model;
  for (const std::size_t state : model_.states) {
    Extremes& range = model_.seen[state];
    range = {std::min(range.low, seen[state].low), std::max(range.high, seen[state].high)};
  }
}

void VelocityFilter::restate(std::span<const double> x, CommandPath between) {
  between_ = between;
  for (std::size_t i = 0; i < to_.size(); ++i) {
    const bool is_state = std::ranges::find(model_.states, i) != model_.states.end();
    to_[i] = is_state || !std::isfinite(x[i]) ? to_[i] : x[i];
  }
}

void VelocityFilter::predict(std::span<const double> x, double dt_s, double factor) {
  from_.swap(to_);
  to_.assign(x.begin(), x.end());
  for (std::size_t i = 0; i < to_.size(); ++i) {
    to_[i] = std::isfinite(to_[i]) ? to_[i] : from_[i];
  }
  yaw_given_ = planar_ && !std::isfinite(x[model_.states[0]]) && std::isfinite(x[model_.states[2]]);
  const auto steps = static_cast<int>(std::ceil(dt_s / step_s_ * (1.0 - 1e-12)));
  for (int k = 0; k < steps; ++k) {
    step(static_cast<double>(k) / steps, static_cast<double>(k + 1) / steps, dt_s / steps, factor);
  }
}

double VelocityFilter::correct(std::span<const Eigen::Index> which, const Vector& values,
                               const Matrix& noise, double widening) {
  const auto count = static_cast<Eigen::Index>(which.size());
  Vector missing(count);
  Matrix cross(mean_.size(), count);
  for (Eigen::Index i = 0; i < count; ++i) {
    missing(i) = values(i) - mean_(which[static_cast<std::size_t>(i)]);
    cross.col(i) = covariance_.col(which[static_cast<std::size_t>(i)]);
  }
  Matrix expected(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    expected.row(i) = cross.row(which[static_cast<std::size_t>(i)]) + noise.row(i);
  }
  const Eigen::LDLT<Matrix> factored(expected);
  const double distance = missing.dot(Vector(factored.solve(missing))) / static_cast<double>(count);
  if (!std::isfinite(distance) || !factored.isPositive()) {
    return 0.0;
  }
  const bool is_far = distance > kFilter.furthest;
  const int doubts = count_doubts(which, missing, is_far);
  // As if the measurement were so much worse that it is just believable.
  double doubt = std::max(1.0, distance / kFilter.furthest);
  Matrix gain = factored.solve(Matrix(cross.transpose())).transpose();
  const double most_step = kFilter.most_step * std::min(widening, 1.0);
  for (Eigen::Index i = 0; i < velocities_; ++i) {
    const double most = most_step * std::sqrt(std::max(covariance_(i, i), 0.0));
    const double move = std::abs(gain.row(i).dot(missing));
    doubt = move > most * doubt ? move / most : doubt;
  }
  gain /= doubt;
  if (is_far && planar_) {
    gain.middleRows(current(), 2).setZero();  // a cut or a wild ping tells nothing of the water
  }
  mean_ += gain * missing;
  const Matrix told = product(gain, cross.transpose());
  covariance_ +=
      product(doubt * product(gain, expected), gain.transpose()) - told - told.transpose();
  covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index state = which[static_cast<std::size_t>(i)];
    doubted_(state) = is_far ? values(i) - mean_(state) : std::numeric_limits<double>::quiet_NaN();
  }
  if (!is_far) {
    extend_range(which, values);
  } else if (doubts >= kFilter.most_doubts) {
    extend_range(which, values);
    loosen(which, missing);
  }
  return distance;
}

// Of each state in turn: a gyro between two pings of a velocity log says nothing of the log.
int VelocityFilter::count_doubts(std::span<const Eigen::Index> which, const Vector& missing,
                                 bool is_far) {
  int doubts = is_far ? 1 : 0;
  if (is_far && agrees(which, missing)) {
    doubts = std::numeric_limits<int>::max();
    for (const Eigen::Index i : which) {
      doubts = std::min(doubts, doubts_[static_cast<std::size_t>(i)] + 1);
    }
  }
  for (const Eigen::Index i : which) {
    doubts_[static_cast<std::size_t>(i)] = doubts;
  }
  return doubts;
}

// The errors of two outliers in succession are alike: the vehicle is elsewhere.
bool VelocityFilter::agrees(std::span<const Eigen::Index> which, const Vector& missing) const {
  for (std::size_t i = 0; i < which.size(); ++i) {
    const double now = missing(static_cast<Eigen::Index>(i));
    const double before = doubted_(which[i]);
    const double width = std::sqrt(std::max(covariance_(which[i], which[i]), 0.0));
    const double most = std::max(kFilter.agreeing * std::abs(now), kFilter.most_step * width);
    if (std::isnan(before) || std::abs(now - before) > most) {
      return false;
    }
  }
  return true;
}

// The error found counts as two standard deviations; nothing else is concluded.
void VelocityFilter::loosen(std::span<const Eigen::Index> which, const Vector& missing) {
  Vector scale = Vector::Ones(mean_.size());
  for (std::size_t i = 0; i < which.size(); ++i) {
    const double deviation = std::sqrt(std::max(covariance_(which[i], which[i]), 1e-300));
    const double found = std::abs(missing(static_cast<Eigen::Index>(i))) / kFilter.sure;
    scale(which[i]) = std::max(1.0, found / deviation);
  }
  Matrix block = covariance_;
  for (const Eigen::Index i : which) {
    covariance_.row(i).setZero();
    covariance_.col(i).setZero();
  }
  for (const Eigen::Index i : which) {
    for (const Eigen::Index k : which) {
      covariance_(i, k) = scale(i) * scale(k) * block(i, k);
    }
  }
}

void VelocityFilter::extend_range(std::span<const Eigen::Index> which, const Vector& values) {
  for (std::size_t i = 0; i < which.size(); ++i) {
    if (which[i] < velocities_) {
      Extremes& range = model_.seen[model_.states[static_cast<std::size_t>(which[i])]];
      const double value = values(static_cast<Eigen::Index>(i));
      range = {std::min(range.low, value), std::max(range.high, value)};
    }
  }
}

VelocityFilter::Vector VelocityFilter::expected_rates(std::span<const double> velocities) {
  Vector s = mean_;
  for (Eigen::Index i = 0; i < velocities_; ++i) {
    const double given = velocities[static_cast<std::size_t>(i)];
    s(i) = std::isfinite(given) ? given : s(i);
  }
  // Commands that are held hold those before, at the end of the step, too.
  const CommandPath between = std::exchange(between_, CommandPath::linear);
  const Vector rates = rate(s, 1.0);
  between_ = between;
  return rates.head(velocities_);
}

void VelocityFilter::take_over(std::span<const Eigen::Index> which, const Vector& values,
                               const Matrix& noise) {
  for (std::size_t i = 0; i < which.size(); ++i) {
    mean_(which[i]) = values(static_cast<Eigen::Index>(i));
    covariance_.row(which[i]).setZero();
    covariance_.col(which[i]).setZero();
  }
  for (std::size_t i = 0; i < which.size(); ++i) {
    for (std::size_t k = 0; k < which.size(); ++k) {
      covariance_(which[i], which[k]) =
          noise(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
    }
  }
}

void VelocityFilter::turn_to(double heading_rad) {
  const Eigen::Matrix2d turn =
      Eigen::Rotation2Dd(heading_rad - mean_(heading())).toRotationMatrix();
  for (const Eigen::Index first : {current(), position()}) {
    mean_.segment<2>(first) = (turn * mean_.segment<2>(first)).eval();
    covariance_.middleRows<2>(first) = (turn * covariance_.middleRows<2>(first)).eval();
    covariance_.middleCols<2>(first) = (covariance_.middleCols<2>(first) * turn.transpose()).eval();
  }
}

void VelocityFilter::take(Eigen::Index state, double value, double variance) {
  if (planar_ && state == heading()) {
    turn_to(value);
  }
  take_over(std::array{state}, Vector::Constant(1, value), Matrix::Constant(1, 1, variance));
}

void VelocityFilter::forget_position() {
  mean_.segment(position(), 2).setZero();
  covariance_.middleRows(position(), 2).setZero();
  covariance_.middleCols(position(), 2).setZero();
}

// ṡ without noise.
VelocityFilter::Vector VelocityFilter::rate(const Vector& s, double share) {
  const bool held = between_ == CommandPath::held;
  for (std::size_t i = 0; i < at_.size(); ++i) {
    at_[i] = held ? from_[i] : from_[i] + share * (to_[i] - from_[i]);
  }
  for (Eigen::Index i = 0; i < velocities_; ++i) {
    at_[model_.states[static_cast<std::size_t>(i)]] = s(i);
  }
  Vector rates = Vector::Zero(s.size());
  double yaw_rate = planar_ ? s(2) : 0.0;
  if (yaw_given_) {
    const std::size_t k = model_.states[2];
    yaw_rate = from_[k] + share * (to_[k] - from_[k]);
    at_[k] = yaw_rate;
  }
  if (planar_) {
    const Eigen::Rotation2Dd to_world(s(heading()));
    const Eigen::Vector2d water = to_world.inverse() * s.segment<2>(current());
    at_[model_.states[0]] -= water.x();
    at_[model_.states[1]] -= water.y();
    rates.segment<2>(position()) = to_world * s.head<2>();
    rates(heading()) = yaw_rate;
    rates(0) = yaw_rate * water.y();  // a current that is constant in the world turns in the body
    rates(1) = -yaw_rate * water.x();
  }
  std::array<double, kMostVelocities> a{};
  const auto count = static_cast<std::size_t>(velocities_);
  model_.accelerations(at_, {a.data(), count});
  for (Eigen::Index i = 0; i < velocities_; ++i) {
    rates(i) += a[static_cast<std::size_t>(i)] + s(velocities_ + i);
    rates(velocities_ + i) = -s(velocities_ + i) / lasting_s(i);
  }
  if (yaw_given_) {
    rates(2) = 0.0;
  }
  return rates;
}

// ∂ṡ/∂s: by central differences where the model is asked, else in closed form.
VelocityFilter::Matrix VelocityFilter::slope(const Vector& s, double share) {
  Matrix slope = Matrix::Zero(s.size(), s.size());
  for (Eigen::Index i = 0; i < velocities_; ++i) {
    const double probe = std::max(slope_probe(model_, static_cast<std::size_t>(i)), 1e-9);
    Vector ahead = s;
    Vector behind = s;
    ahead(i) += probe;
    behind(i) -= probe;
    slope.col(i) = (rate(ahead, share) - rate(behind, share)) / (2.0 * probe);
    slope(velocities_ + i, velocities_ + i) = -1.0 / lasting_s(i);
    slope(i, velocities_ + i) = 1.0;
  }
  if (planar_) {
    const Eigen::Matrix2d to_world = Eigen::Rotation2Dd(s(heading())).toRotationMatrix();
    const Eigen::Vector2d water = to_world.transpose() * s.segment<2>(current());
    Eigen::Matrix<double, Eigen::Dynamic, 2, 0, Matrix::MaxRowsAtCompileTime, 2> by_water =
        -slope.topLeftCorner(velocities_, 2);
    by_water(0, 1) += s(2);
    by_water(1, 0) -= s(2);
    slope.block(0, current(), velocities_, 2) = by_water * to_world.transpose();
    slope.block(0, heading(), velocities_, 1) = by_water * Eigen::Vector2d(water.y(), -water.x());
    slope.block(position(), heading(), 2, 1) = to_world * Eigen::Vector2d(-s(1), s(0));
  }
  return slope;
}

void VelocityFilter::step(double from, double to, double step_s, double factor) {
  const double middle = 0.5 * (from + to);
  const Matrix by_state = step_s * slope(mean_, from);
  const Matrix onward =
      Matrix::Identity(mean_.size(), mean_.size()) + by_state + 0.5 * product(by_state, by_state);
  const Vector k1 = rate(mean_, from);
  const Vector k2 = rate(mean_ + 0.5 * step_s * k1, middle);
  const Vector k3 = rate(mean_ + 0.5 * step_s * k2, middle);
  const Vector k4 = rate(mean_ + step_s * k3, to);
  mean_ += step_s / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  covariance_ = product(product(onward, covariance_), onward.transpose());
  add_noise(step_s, factor);
  keep_in_range();
}

double VelocityFilter::lasting_s(Eigen::Index velocity) const {
  return std::clamp(model_.error_time_s[static_cast<std::size_t>(velocity)], kFilter.least_time_s,
                    kFilter.most_time_s);
}

void VelocityFilter::add_noise(double step_s, double factor) {
  for (Eigen::Index i = 0; i < velocities_; ++i) {
    const auto state = static_cast<std::size_t>(i);
    covariance_(velocities_ + i, velocities_ + i) += factor * model_.error[state] *
                                                     model_.error[state] *
                                                     (1.0 - std::exp(-2.0 * step_s / lasting_s(i)));
  }
  if (planar_ && current_m_s_ > 0.0) {
    covariance_.diagonal().segment(current(), 2).array() +=
        current_wander_ * current_wander_ * step_s;
  }
}

// No velocity leaves what was seen by more than half its width, nor does its variance grow beyond
// that.
void VelocityFilter::keep_in_range() {
  for (Eigen::Index i = 0; i < velocities_; ++i) {
    const auto state = static_cast<std::size_t>(i);
    const double width = seen_width(model_, state);
    mean_(i) = bounded_velocity(seen_velocities(model_, state), mean_(i));
    if (covariance_(i, i) > width * width) {
      const double shrink = width / std::sqrt(covariance_(i, i));
      covariance_.row(i) *= shrink;
      covariance_.col(i) *= shrink;
    }
  }
}

}  // namespace kelpie
