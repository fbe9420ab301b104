// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/rollout.hpp"

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

// Where an age is among the practised ages: from the one before to the next, by the logarithm.
struct Between {
  std::size_t before = 0;
  std::size_t after = 0;
  double share = 0.0;
};

Between between(double age_s) {
  const auto next = std::ranges::upper_bound(kPractisedAges, age_s) - kPractisedAges.begin();
  const auto after = std::min(static_cast<std::size_t>(next), kPractisedAges.size() - 1);
  if (next == 0 || static_cast<std::size_t>(next) == kPractisedAges.size()) {
    return {after, after, 0.0};
  }
  const double low = kPractisedAges[after - 1];
  return {after - 1, after, std::log(age_s / low) / std::log(kPractisedAges[after] / low)};
}

double kept_at(const ByAge& kept, double age_s) {
  const auto [before, after, share] = between(age_s);
  return kept[before] + share * (kept[after] - kept[before]);
}

double off_at(const ByAge& off, double noise, double age_s) {
  if (age_s < kPractisedAges.front()) {
    return noise + age_s / kPractisedAges.front() * (std::max(off.front(), noise) - noise);
  }
  const auto growth = [&](std::size_t to) {
    const double known = std::min(off[to - 1], off[to]);
    return known > 0.0 ? std::log(off[to] / off[to - 1]) /
                             std::log(kPractisedAges[to] / kPractisedAges[to - 1])
                       : 0.0;
  };
  const auto [before, after, share] = between(age_s);
  const double slope =
      before < after ? growth(after) : std::clamp(growth(after), 0.0, kRollout.diffusion);
  return off[before] * std::pow(age_s / kPractisedAges[before], slope);
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
      integrated_(model_.states),
      measured_(model_.states.size(), false),
      x_(model_.seen.size()),
      from_(x_),
      to_(x_),
      at_(x_) {
  require(model_.states.size() <= kMostStates, "states",
          "of a rollout are at most " + std::to_string(kMostStates));
  settings_.validate(model_.states.size());
  bool turns_as_measured = false;
  for (const std::size_t state : settings_.measured) {
    measured_[state] = true;
    turns_as_measured = turns_as_measured || model_.attitude.follows(model_.states[state]);
  }
  if (!turns_as_measured) {
    integrated_.insert(integrated_.end(), model_.attitude.inputs().begin(),
                       model_.attitude.inputs().end());
    measured_.resize(integrated_.size(), false);
  }
}

void Rollout::start(std::span<const double> x) {
  require_size("x", x.size(), x_.size());
  x_.assign(x.begin(), x.end());
  to_ = x_;
  for (std::size_t i = 0; i < model_.states.size(); ++i) {
    start_[i] = x[model_.states[i]];
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
    const auto found = std::ranges::find(integrated_, i);
    const auto place = static_cast<std::size_t>(found - integrated_.begin());
    if (found == integrated_.end() || measured_[place]) {
      x_[i] = to_[i];
    }
  }
}

double Rollout::velocity(std::size_t state) const {
  const double now = x_[model_.states[state]];
  if (measured_[state] || model_.kept.empty()) {
    return now;
  }
  return start_[state] + kept_at(model_.kept[state], age_s_) * (now - start_[state]);
}

double Rollout::spread(std::size_t state) const {
  if (measured_[state]) {
    return 0.0;
  }
  const double noise = model_.noise[state];
  const double off = model_.off.empty() ? noise : off_at(model_.off[state], noise, age_s_);
  return std::min(off, seen_width(model_, state));
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
  for (const std::size_t i : model_.states) {
    at_[i] = from_[i] + share * (to_[i] - from_[i]);
  }
}

Rollout::Vector Rollout::rate(const Vector& values, double share) {
  place(share);
  for (std::size_t i = 0; i < integrated_.size(); ++i) {
    if (!measured_[i]) {
      at_[integrated_[i]] = values[i];
    }
  }
  Vector a{};
  const std::size_t states = model_.states.size();
  model_.accelerations(at_, {a.data(), states});
  if (integrated_.size() > states) {
    model_.attitude.rates(at_, std::span(a).subspan(states));
  }
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
  Vector values{};
  for (std::size_t i = 0; i < integrated_.size(); ++i) {
    values[i] = x_[integrated_[i]];
  }
  const Vector k1 = rate(values, from);
  const Vector k2 = rate(after(values, half_s, k1), middle);
  const Vector k3 = rate(after(values, half_s, k2), middle);
  const Vector k4 = rate(after(values, step_s, k3), to);
  for (std::size_t i = 0; i < integrated_.size(); ++i) {
    const double ahead = values[i] + step_s * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]) / 6.0;
    x_[integrated_[i]] =
        i < model_.states.size() ? bounded_velocity(seen_velocities(model_, i), ahead) : ahead;
  }
  age_s_ += step_s;
}

}  // namespace kelpie
