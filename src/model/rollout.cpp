// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/rollout.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "kelpie/core/error.hpp"

namespace kelpie {
namespace {

constexpr double kLeeway = 0.5;   // of the range seen, in which velocities stay
constexpr double kBeyond = 0.05;  // of it, from which an input counts as outside
constexpr double kProbe = 1e-4;   // of it: step of the differences for the slope

}  // namespace

void RolloutSettings::validate(std::size_t states) const {
  require(step_s > 0.0 && std::isfinite(step_s), "step", "has to be > 0 s");
  for (const std::size_t state : measured) {
    require(state < states, "measured",
            "number " + std::to_string(state) + "; there are " + std::to_string(states) +
                " velocities, counted from 0");
  }
}

Rollout::Rollout(OpenLoop model, RolloutSettings settings)
    : model_(std::move(model)),
      settings_(std::move(settings)),
      measured_(model_.states.size(), false),
      x_(model_.seen.size()),
      from_(x_),
      to_(x_),
      at_(x_) {
  require(model_.states.size() <= kMostStates, "states",
          "of a rollout are at most " + std::to_string(kMostStates));
  settings_.validate(model_.states.size());
  for (const std::size_t state : settings_.measured) {
    measured_[state] = true;
  }
}

void Rollout::start(std::span<const double> x) {
  x_.assign(x.begin(), x.end());
  to_ = x_;
  const auto states = static_cast<Eigen::Index>(model_.states.size());
  velocity_spread_ = Matrix::Zero(states, states);
  cross_spread_ = Matrix::Zero(states, states);
  error_spread_.resize(states);
  for (Eigen::Index i = 0; i < states; ++i) {
    const double error = model_.error[static_cast<std::size_t>(i)];
    error_spread_[i] = error * error;
    const double noise =
        measured_[static_cast<std::size_t>(i)] ? 0.0 : model_.noise[static_cast<std::size_t>(i)];
    velocity_spread_(i, i) = noise * noise;
  }
  age_s_ = 0.0;
}

void Rollout::advance(std::span<const double> x, double dt_s) {
  from_ = to_;
  to_.assign(x.begin(), x.end());
  const auto steps = static_cast<int>(std::ceil(dt_s / settings_.step_s * (1.0 - 1e-12)));
  for (int step = 0; step < steps; ++step) {
    integrate(static_cast<double>(step) / steps, static_cast<double>(step + 1) / steps,
              dt_s / steps);
  }
  for (std::size_t i = 0; i < to_.size(); ++i) {
    const auto state = std::ranges::find(model_.states, i);
    if (state == model_.states.end() ||
        !integrated(static_cast<std::size_t>(state - model_.states.begin()))) {
      x_[i] = to_[i];
    }
  }
}

double Rollout::spread(std::size_t state) const {
  const auto i = static_cast<Eigen::Index>(state);
  return std::sqrt(std::max(velocity_spread_(i, i), 0.0));
}

bool Rollout::beyond() const {
  for (std::size_t i = 0; i < x_.size(); ++i) {
    const Extremes& range = model_.seen[i];
    const double leeway = kBeyond * (range.high - range.low);
    if (x_[i] < range.low - leeway || x_[i] > range.high + leeway) {
      return true;
    }
  }
  return false;
}

// Puts everything that isn't integrated where it is at a share of the way between two samples.
void Rollout::place(double share) {
  const bool held = settings_.between == CommandPath::held;
  for (std::size_t i = 0; i < at_.size(); ++i) {
    at_[i] = held ? from_[i] : from_[i] + share * (to_[i] - from_[i]);
  }
  for (std::size_t state = 0; state < measured_.size(); ++state) {
    const std::size_t i = model_.states[state];
    at_[i] = from_[i] + share * (to_[i] - from_[i]);
  }
}

Rollout::Vector Rollout::rate(const Vector& velocity, double share, double age_s) {
  place(share);
  for (std::size_t state = 0; state < measured_.size(); ++state) {
    if (integrated(state)) {
      at_[model_.states[state]] = velocity[static_cast<Eigen::Index>(state)];
    }
  }
  Vector a(velocity.size());
  model_.accelerations(at_, age_s, {a.data(), measured_.size()});
  for (std::size_t state = 0; state < measured_.size(); ++state) {
    if (measured_[state]) {
      a[static_cast<Eigen::Index>(state)] = 0.0;
    }
  }
  return a;
}

// One step, between two shares of the way from one sample to the next.
void Rollout::integrate(double from, double to, double step_s) {
  const auto states = static_cast<Eigen::Index>(model_.states.size());
  const double middle = 0.5 * (from + to);
  Vector velocity(states);
  for (Eigen::Index i = 0; i < states; ++i) {
    velocity[i] = x_[model_.states[static_cast<std::size_t>(i)]];
  }
  if (error_spread_.any() || velocity_spread_.any()) {
    carry_spread(slope(velocity, from), step_s);
  }
  const Vector k1 = rate(velocity, from, age_s_);
  const Vector k2 = rate(velocity + 0.5 * step_s * k1, middle, age_s_ + 0.5 * step_s);
  const Vector k3 = rate(velocity + 0.5 * step_s * k2, middle, age_s_ + 0.5 * step_s);
  const Vector k4 = rate(velocity + step_s * k3, to, age_s_ + step_s);
  velocity = bounded(velocity + step_s / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4));
  for (Eigen::Index i = 0; i < states; ++i) {
    x_[model_.states[static_cast<std::size_t>(i)]] = velocity[i];
  }
  age_s_ += step_s;
}

// ∂a/∂ν by central differences; 0 for what is measured.
Rollout::Matrix Rollout::slope(const Vector& velocity, double share) {
  Matrix slope = Matrix::Zero(velocity.size(), velocity.size());
  for (Eigen::Index i = 0; i < velocity.size(); ++i) {
    const Extremes& range = model_.seen[model_.states[static_cast<std::size_t>(i)]];
    const double probe = kProbe * (range.high - range.low);
    if (integrated(static_cast<std::size_t>(i)) && probe > 0.0) {
      Vector ahead = velocity;
      Vector behind = velocity;
      ahead[i] += probe;
      behind[i] -= probe;
      slope.col(i) = (rate(ahead, share, age_s_) - rate(behind, share, age_s_)) / (2.0 * probe);
    }
  }
  return slope;
}

// Covariance of ν' = slope ν + d with d a first-order Gauss-Markov process per axis.
void Rollout::carry_spread(const Matrix& slope, double step_s) {
  const Eigen::Index states = slope.rows();
  const Matrix onward =
      Matrix::Identity(states, states) + step_s * slope + 0.5 * step_s * step_s * slope * slope;
  Vector lasting(states);
  for (Eigen::Index i = 0; i < states; ++i) {
    const auto state = static_cast<std::size_t>(i);
    const double time_s = model_.error_time_s[state];
    lasting[i] = time_s > 0.0 ? std::exp(-step_s / time_s) : 0.0;
    if (measured_[state]) {
      error_spread_[i] = 0.0;
    }
  }
  const Matrix errors = error_spread_.asDiagonal();
  const Matrix crossed = onward * cross_spread_;
  velocity_spread_ = onward * velocity_spread_ * onward.transpose() +
                     step_s * (crossed + crossed.transpose()) + step_s * step_s * errors;
  cross_spread_ = (crossed + step_s * errors) * lasting.asDiagonal();
  for (Eigen::Index i = 0; i < states; ++i) {
    const Extremes& range = model_.seen[model_.states[static_cast<std::size_t>(i)]];
    const double most = range.high - range.low;
    if (velocity_spread_(i, i) > most * most) {
      const double shrink = most / std::sqrt(velocity_spread_(i, i));
      velocity_spread_.row(i) *= shrink;
      velocity_spread_.col(i) *= shrink;
      cross_spread_.row(i) *= shrink;
    }
  }
}

Rollout::Vector Rollout::bounded(Vector velocity) const {
  for (Eigen::Index i = 0; i < velocity.size(); ++i) {
    const Extremes& range = model_.seen[model_.states[static_cast<std::size_t>(i)]];
    const double leeway = kLeeway * (range.high - range.low);
    velocity[i] = std::clamp(velocity[i], range.low - leeway, range.high + leeway);
  }
  return velocity;
}

}  // namespace kelpie
