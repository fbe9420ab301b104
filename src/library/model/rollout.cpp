// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/rollout.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "kelpie/core/error.hpp"
#include "model/seen_velocities.hpp"
#include "model/tuning.hpp"

namespace kelpie {
namespace {

constexpr const auto& kRollout = kModelTuning.rollout;

template <typename Values>
Values after(Values values, double step, const Values& slope) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] += step * slope[i];
  }
  return values;
}

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
  require_size("x", x.size(), x_.size());
  x_.assign(x.begin(), x.end());
  to_ = x_;
  velocity_spread_ = {};
  cross_spread_ = {};
  for (std::size_t i = 0; i < measured_.size(); ++i) {
    error_spread_[i] = model_.error[i] * model_.error[i];
    const double noise = measured_[i] ? 0.0 : model_.noise[i];
    velocity_spread_[diagonal(i)] = noise * noise;
  }
  age_s_ = 0.0;
}

void Rollout::advance(std::span<const double> x, double dt_s) {
  require_size("x", x.size(), x_.size());
  require(std::isfinite(dt_s) && dt_s <= kMostSteps * settings_.step_s, "dt_s",
          "has to be finite, and at most a million steps of the integrator");
  from_ = to_;
  to_.assign(x.begin(), x.end());
  const double passed_s = std::max(dt_s, 0.0);
  const auto steps = static_cast<int>(std::ceil(passed_s / settings_.step_s * (1.0 - 1e-12)));
  for (int step = 0; step < steps; ++step) {
    integrate(static_cast<double>(step) / steps, static_cast<double>(step + 1) / steps,
              passed_s / steps);
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
  return std::sqrt(std::max(velocity_spread_[diagonal(state)], 0.0));
}

bool Rollout::beyond() const {
  for (std::size_t i = 0; i < x_.size(); ++i) {
    const Extremes& range = model_.seen[i];
    const double leeway = kRollout.beyond * (range.high - range.low);
    const bool is_within = x_[i] >= range.low - leeway && x_[i] <= range.high + leeway;
    if (!is_within) {  // NaN is not
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
      at_[model_.states[state]] = velocity[state];
    }
  }
  Vector a{};
  model_.accelerations(at_, age_s, {a.data(), measured_.size()});
  for (std::size_t state = 0; state < measured_.size(); ++state) {
    if (measured_[state]) {
      a[state] = 0.0;
    }
  }
  return a;
}

// One step, between two shares of the way from one sample to the next.
void Rollout::integrate(double from, double to, double step_s) {
  const double middle = 0.5 * (from + to);
  const double half_s = 0.5 * step_s;
  Vector velocity{};
  for (std::size_t i = 0; i < measured_.size(); ++i) {
    velocity[i] = x_[model_.states[i]];
  }
  const auto none = [](double spread) { return spread == 0.0; };
  if (!std::ranges::all_of(error_spread_, none) || !std::ranges::all_of(velocity_spread_, none)) {
    carry_spread(slope(velocity, from), step_s);
  }
  const Vector k1 = rate(velocity, from, age_s_);
  const Vector k2 = rate(after(velocity, half_s, k1), middle, age_s_ + half_s);
  const Vector k3 = rate(after(velocity, half_s, k2), middle, age_s_ + half_s);
  const Vector k4 = rate(after(velocity, step_s, k3), to, age_s_ + step_s);
  for (std::size_t i = 0; i < measured_.size(); ++i) {
    const double mean = (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]) / 6.0;
    x_[model_.states[i]] = bounded_velocity(model_, i, velocity[i] + step_s * mean);
  }
  age_s_ += step_s;
}

// ∂a/∂ν by central differences; 0 for what is measured.
Rollout::Square Rollout::slope(const Vector& velocity, double share) {
  Square slope{};
  for (std::size_t i = 0; i < measured_.size(); ++i) {
    const double probe = slope_probe(model_, i);
    if (integrated(i) && probe > 0.0) {
      Vector ahead = velocity;
      Vector behind = velocity;
      ahead[i] += probe;
      behind[i] -= probe;
      const Vector above = rate(ahead, share, age_s_);
      const Vector below = rate(behind, share, age_s_);
      for (std::size_t k = 0; k < measured_.size(); ++k) {
        slope[i * kMostStates + k] = (above[k] - below[k]) / (2.0 * probe);
      }
    }
  }
  return slope;
}

// Covariance of ν' = slope ν + d with d a first-order Gauss-Markov process per axis.
void Rollout::carry_spread(const Square& slope, double step_s) {
  using Columns = Eigen::Matrix<double, kMostStates, kMostStates>;
  const Eigen::Map<const Columns> by_velocity(slope.data());
  const Columns onward = Columns::Identity() + step_s * by_velocity +
                         0.5 * step_s * step_s * by_velocity * by_velocity;
  Eigen::Vector<double, kMostStates> lasting = Eigen::Vector<double, kMostStates>::Zero();
  for (std::size_t i = 0; i < measured_.size(); ++i) {
    const double time_s = model_.error_time_s[i];
    lasting[static_cast<Eigen::Index>(i)] = time_s > 0.0 ? std::exp(-step_s / time_s) : 0.0;
    if (measured_[i]) {
      error_spread_[i] = 0.0;
    }
  }
  const Columns errors =
      Eigen::Map<const Eigen::Vector<double, kMostStates>>(error_spread_.data()).asDiagonal();
  Eigen::Map<Columns> velocities(velocity_spread_.data());
  Eigen::Map<Columns> cross(cross_spread_.data());
  const Columns crossed = onward * cross;
  velocities = (onward * velocities * onward.transpose() +
                step_s * (crossed + crossed.transpose()) + step_s * step_s * errors)
                   .eval();
  cross = (crossed + step_s * errors) * lasting.asDiagonal();
  for (std::size_t state = 0; state < measured_.size(); ++state) {
    const auto i = static_cast<Eigen::Index>(state);
    const double most = seen_width(model_, state);
    if (velocities(i, i) > most * most) {
      const double shrink = most / std::sqrt(velocities(i, i));
      velocities.row(i) *= shrink;
      velocities.col(i) *= shrink;
      cross.row(i) *= shrink;
    }
  }
}

}  // namespace kelpie
