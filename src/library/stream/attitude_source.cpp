// SPDX-License-Identifier: Apache-2.0
#include "stream/attitude_source.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/angle.hpp"

namespace kelpie {

Triple roll_pitch_yaw(const std::array<double, 4>& quaternion) {
  const Triple x = in_body(Triple{1.0, 0.0, 0.0}, quaternion);  // the first row of R
  const Triple y = in_body(Triple{0.0, 1.0, 0.0}, quaternion);
  const Triple z = in_body(Triple{0.0, 0.0, 1.0}, quaternion);
  return {std::atan2(z[1], z[2]), std::asin(std::clamp(-z[0], -1.0, 1.0)), std::atan2(y[0], x[0])};
}

AttitudeSource::AttitudeSource(std::vector<std::size_t> places, double unit, bool by_stamps)
    : places_(std::move(places)), unit_(unit), by_stamps_(by_stamps) {}

// The three angles, or the quaternion.
std::array<double, 4> AttitudeSource::at(std::span<const SignalHistory> signals,
                                         double time_s) const {
  std::array<double, 4> before{};
  std::array<double, 4> step{};
  double share = 0.0;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (places_[i] == kNone) {
      continue;
    }
    const SignalHistory& signal = signals[places_[i]];
    const double t = time_s - (by_stamps_ ? signal.lag_s() : 0.0);
    before[i] = signal.at(t, Interpolation::line);
    const std::size_t after = signal.first_after(t);
    if (std::isfinite(before[i]) && after > 0 && after < signal.size()) {
      const double begin_s = signal.time_s(after - 1);
      before[i] = signal.value(after - 1);
      step[i] = signal.value(after) - before[i];
      share = (t - begin_s) / (signal.time_s(after) - begin_s);
    }
    if (!is_quaternion()) {
      before[i] = unit_ * before[i] + share * wrapped(unit_ * step[i]);
      step[i] = 0.0;
    }
  }
  if (!is_quaternion()) {
    return before;
  }
  double along = 0.0;  // a quaternion and its opposite are one attitude
  for (std::size_t i = 0; i < before.size(); ++i) {
    along += before[i] * (before[i] + step[i]);
  }
  for (std::size_t i = 0; i < before.size(); ++i) {
    const double next = along < 0.0 ? -(before[i] + step[i]) : before[i] + step[i];
    before[i] += share * (next - before[i]);
  }
  return before;
}

Triple AttitudeSource::in_body(std::span<const SignalHistory> signals, const Triple& vector,
                               double time_s) const {
  const std::array<double, 4> now = at(signals, time_s);
  return is_quaternion() ? kelpie::in_body(vector, now)
                         : kelpie::in_body(vector, Triple{now[0], now[1], now[2]});
}

Triple AttitudeSource::angles(std::span<const SignalHistory> signals, double time_s) const {
  const std::array<double, 4> now = at(signals, time_s);
  return is_quaternion() ? roll_pitch_yaw(now) : Triple{now[0], now[1], now[2]};
}

}  // namespace kelpie
