// SPDX-License-Identifier: Apache-2.0
#include "navigation/velocity_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "navigation/tuning.hpp"

namespace kelpie {
namespace {

constexpr const auto& kCheck = kNavigationTuning.check;

std::size_t states_of(const VelocityFilter& filter) {
  return static_cast<std::size_t>(filter.velocities());
}

}  // namespace

VelocityCheck::Faults VelocityCheck::judge(std::span<const double> x, double t,
                                           VelocityFilter& filter) {
  Faults faults{};
  Values now{};
  bool is_zero = true;
  bool repeats = has_last_;
  std::size_t heard = 0;
  double changed_s = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < states_of(filter); ++i) {
    now[i] = x[filter.model().states[i]];
    faults[i] = std::isfinite(now[i]) ? VelocityFault::none : VelocityFault::missing;
    if (faults[i] == VelocityFault::none && filter.is_of_log(static_cast<Eigen::Index>(i))) {
      ++heard;
      is_zero = is_zero && now[i] == 0.0;
      repeats = repeats && now[i] == last_[i];
      changed_s = std::max(changed_s, changed_s_[i]);
    }
  }
  if (heard == 0) {
    return faults;
  }
  VelocityFault all = VelocityFault::none;
  if (repeats || is_zero) {
    if (!in_stretch_) {
      stretch_s_ = repeats ? changed_s : t;
      contradicted_ = false;
    }
    in_stretch_ = true;
    contradicted_ = contradicted_ || would_move(filter, now) || contradicts(filter, now);
    all = judge_all(filter, now, is_zero, t);
  } else {
    in_stretch_ = false;
    const double apart_s = has_last_ ? t - changed_s : 0.0;
    usual_s_ += kCheck.hold_memory * (std::min(apart_s, frozen_after_s()) - usual_s_);
  }
  for (std::size_t i = 0; i < states_of(filter); ++i) {
    if (faults[i] == VelocityFault::none && filter.is_of_log(static_cast<Eigen::Index>(i))) {
      faults[i] = all != VelocityFault::none         ? all
                  : is_one_frozen(filter, now, i, t) ? VelocityFault::frozen
                                                     : VelocityFault::none;
    }
  }
  remember(now, t);
  return faults;
}

VelocityFault VelocityCheck::judge_all(const VelocityFilter& filter, const Values& now,
                                       bool is_zero, double t) {
  const double lasted_s = t - stretch_s_;
  const bool is_still = VelocityCheck::is_still(filter, now);
  if (is_zero && contradicted_) {
    return VelocityFault::zero;
  }
  if ((contradicted_ || !is_still) && lasted_s > frozen_after_s()) {
    contradicted_ = true;
    return VelocityFault::frozen;
  }
  return is_still && !contradicted_ && lasted_s >= kCheck.rest_s ? VelocityFault::none
                                                                 : VelocityFault::repeated;
}

// A driver may hold the values of a slower sensor.
double VelocityCheck::frozen_after_s() const {
  return std::max(kCheck.frozen_s, kCheck.usual_hold * usual_s_);
}

// Of one velocity among others that change; a sensor that measures nothing along an axis may give
// a constant that nothing contradicts.
bool VelocityCheck::is_one_frozen(VelocityFilter& filter, const Values& now, std::size_t state,
                                  double t) const {
  if (!has_last_ || now[state] != last_[state] || equal_[state] < kCheck.least_equal ||
      t - changed_s_[state] <= frozen_after_s()) {
    return false;
  }
  const auto place = static_cast<Eigen::Index>(state);
  const double off = std::abs(now[state] - filter.mean()(place));
  const double rate = std::abs(filter.expected_rates(now)(place));
  return off > kCheck.sigmas * std::sqrt(std::max(filter.covariance()(place, place), 0.0)) ||
         rate > kCheck.sigmas * filter.model().error[state];
}

bool VelocityCheck::contradicts(const VelocityFilter& filter, const Values& now) {
  for (std::size_t i = 0; i < states_of(filter); ++i) {
    const auto place = static_cast<Eigen::Index>(i);
    const double noise = filter.model().noise[i];
    const double deviation =
        std::sqrt(std::max(filter.covariance()(place, place), 0.0) + noise * noise);
    if (std::isfinite(now[i]) && filter.is_of_log(static_cast<Eigen::Index>(i)) &&
        std::abs(now[i] - filter.mean()(place)) > kCheck.sigmas * deviation) {
      return true;
    }
  }
  return false;
}

bool VelocityCheck::is_still(const VelocityFilter& filter, const Values& now) {
  for (std::size_t i = 0; i < states_of(filter); ++i) {
    if (std::isfinite(now[i]) && filter.is_of_log(static_cast<Eigen::Index>(i)) &&
        std::abs(now[i]) > kCheck.sigmas * filter.model().noise[i]) {
      return false;
    }
  }
  return true;
}

bool VelocityCheck::would_move(VelocityFilter& filter, const Values& now) {
  const VelocityFilter::Vector rates = filter.expected_rates(now);
  for (std::size_t i = 0; i < states_of(filter); ++i) {
    if (std::isfinite(now[i]) && filter.is_of_log(static_cast<Eigen::Index>(i)) &&
        std::abs(rates(static_cast<Eigen::Index>(i))) > kCheck.sigmas * filter.model().error[i]) {
      return true;
    }
  }
  return false;
}

void VelocityCheck::remember(const Values& now, double t) {
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (!std::isfinite(now[i])) {
      continue;
    }
    const bool is_equal = has_last_ && now[i] == last_[i];
    equal_[i] = is_equal ? equal_[i] + 1 : 0;
    changed_s_[i] = is_equal ? changed_s_[i] : t;
    last_[i] = now[i];
  }
  has_last_ = true;
}

}  // namespace kelpie
