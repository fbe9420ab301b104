// SPDX-License-Identifier: Apache-2.0
#include "stream/pose_window.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/angle.hpp"
#include "stream/tuning.hpp"

namespace kelpie {
namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();
// (1 − s²)³ (a + b s²) with integral 1 and second moment 0.
constexpr double kConstant = 945.0 / 512.0;
constexpr double kSquare = -3465.0 / 512.0;

std::size_t source_place(const StreamPlan& plan, const std::string& name) {
  return name.empty() ? AttitudeSource::kNone : plan.source(name);
}

std::vector<std::size_t> attitude_of(const StreamPlan& plan) {
  std::vector<std::size_t> places;
  for (const std::string& name : plan.pose->attitude) {
    places.push_back(source_place(plan, name));
  }
  return places;
}

// A horizontal position turns by the heading; a height alone stays along the world's axis.
std::vector<std::size_t> turn_of(const StreamPlan& plan) {
  const std::array<std::string, 3>& position = plan.pose->position;
  std::vector<std::size_t> places = attitude_of(plan);
  if (position[0].empty()) {
    return {};
  }
  if (position[2].empty() && places.size() == 3) {
    places[0] = places[1] = AttitudeSource::kNone;
  }
  return places;
}

}  // namespace

double PoseKernel::weight(double s) {
  const double rest = 1.0 - s * s;
  return std::abs(s) < 1.0 ? rest * rest * rest * (kConstant + kSquare * s * s) : 0.0;
}

double PoseKernel::slope(double s) {
  const double rest = 1.0 - s * s;
  return std::abs(s) < 1.0
             ? rest * rest * 2.0 * s * (kSquare * rest - 3.0 * (kConstant + kSquare * s * s))
             : 0.0;
}

double PoseKernel::integral(double s) {
  const double at = std::clamp(s, -1.0, 1.0);
  const double q = at * at;
  return at * (kConstant + q * ((kSquare - 3.0 * kConstant) / 3.0 +
                                q * (3.0 * (kConstant - kSquare) / 5.0 +
                                     q * ((3.0 * kSquare - kConstant) / 7.0 - q * kSquare / 9.0))));
}

PoseWindow::PoseWindow(const StreamPlan& plan, std::size_t most)
    : pose_(*plan.pose),
      gap_s_(plan.gap_s),
      attitude_(attitude_of(plan), 1.0, false),
      turned_by_(turn_of(plan), 1.0, false),
      axes_(pose_.axes()),
      weights_(most),
      slopes_(most),
      values_(pose_.columns().size(), kNoValue) {
  for (std::size_t part = 0; part < position_.size(); ++part) {
    position_[part] = source_place(plan, pose_.position[part]);
  }
}

// The weights of the increments p(i+1) − p(i) at the middle of their times: a constant velocity has
// the mean itself and the slope 0, a steady acceleration the slope itself, for any spacing.
std::optional<PoseWindow::Increments> PoseWindow::weigh(const SignalHistory& signal) {
  const double half_s = pose_.half_s - stream::kTuning.window_rounding_s;
  const std::size_t after = signal.first_after(t_ - half_s);
  const std::size_t end = signal.first_after(t_ + half_s);
  if (after == 0 || end == signal.size() || end - after + 1 < stream::kTuning.pose_increments) {
    return std::nullopt;
  }
  const Increments found{.first = after - 1, .count = end - after + 1};
  double area = 0.0;
  double drift = 0.0;
  for (std::size_t i = 0; i < found.count; ++i) {
    const double begin_s = signal.time_s(found.first + i);
    const double step_s = signal.time_s(found.first + i + 1) - begin_s;
    if (step_s > gap_s_ || step_s > pose_.half_s) {
      return std::nullopt;
    }
    const double s = (begin_s + 0.5 * step_s - t_) / pose_.half_s;
    weights_[i] = PoseKernel::weight(s);
    slopes_[i] = -PoseKernel::slope(s);
    area += weights_[i] * step_s;
    drift += slopes_[i] * step_s;
  }
  double gain = 0.0;
  for (std::size_t i = 0; i < found.count; ++i) {
    const double begin_s = signal.time_s(found.first + i);
    const double step_s = signal.time_s(found.first + i + 1) - begin_s;
    weights_[i] /= area;
    slopes_[i] -= drift * weights_[i];
    gain += slopes_[i] * step_s * (begin_s + 0.5 * step_s - t_);
  }
  for (std::size_t i = 0; i < found.count; ++i) {
    slopes_[i] /= gain;
  }
  return found;
}

// increment(i, middle_s): what the step from sample i to i + 1 adds to the six velocities.
template <typename Increment>
void PoseWindow::add(const SignalHistory& signal, Increment increment) {
  const std::optional<Increments> steps = weigh(signal);
  if (!steps) {
    velocity_.fill(kNoValue);
    acceleration_.fill(kNoValue);
    return;
  }
  for (std::size_t i = 0; i < steps->count; ++i) {
    const std::size_t at = steps->first + i;
    const Motion way = increment(at, 0.5 * (signal.time_s(at) + signal.time_s(at + 1)));
    for (std::size_t axis = 0; axis < way.size(); ++axis) {
      velocity_[axis] += weights_[i] * way[axis];
      acceleration_[axis] += slopes_[i] * way[axis];
    }
  }
}

void PoseWindow::add_position(std::span<const SignalHistory> signals, std::size_t part) {
  const SignalHistory& signal = signals[position_[part]];
  add(signal, [&](std::size_t i, double middle_s) {
    Triple way{};
    way[part] = signal.value(i + 1) - signal.value(i);
    way = turned_by_.places().empty() ? way : turned_by_.in_body(signals, way, middle_s);
    return Motion{way[0], way[1], way[2], 0.0, 0.0, 0.0};
  });
}

// Rates of the body by Fossen 2011, eq. (2.28), for one of the angles.
void PoseWindow::add_angle(std::span<const SignalHistory> signals, std::size_t part) {
  const bool is_quaternion = attitude_.is_quaternion();
  const SignalHistory& signal = signals[attitude_.places()[is_quaternion ? 0 : part]];
  const auto angle = [&](std::size_t i) {
    return is_quaternion ? attitude_.angles(signals, signal.time_s(i))[part] : signal.value(i);
  };
  add(signal, [&](std::size_t i, double middle_s) {
    const double turn = wrapped(angle(i + 1) - angle(i));
    const auto [roll, pitch, yaw] = attitude_.angles(signals, middle_s);
    Motion way{};
    if (part == 0) {
      way[3] = turn;
    } else if (part == 1) {
      way[4] = std::cos(roll) * turn;
      way[5] = -std::sin(roll) * turn;
    } else {
      way[3] = -std::sin(pitch) * turn;
      way[4] = std::sin(roll) * std::cos(pitch) * turn;
      way[5] = std::cos(roll) * std::cos(pitch) * turn;
    }
    return way;
  });
}

void PoseWindow::move_to(std::span<const SignalHistory> signals, double t) {
  t_ = t;
  velocity_.fill(0.0);
  acceleration_.fill(0.0);
  for (std::size_t part = 0; part < position_.size(); ++part) {
    if (position_[part] != AttitudeSource::kNone) {
      add_position(signals, part);
    }
  }
  for (std::size_t part = 0; part < 3 && !attitude_.places().empty(); ++part) {
    if (attitude_.is_quaternion() || attitude_.places()[part] != AttitudeSource::kNone) {
      add_angle(signals, part);
    }
  }
  set_values(signals);
}

void PoseWindow::set_values(std::span<const SignalHistory> signals) {
  std::size_t column = 0;
  for (const std::size_t axis : axes_) {
    values_[column++] = velocity_[axis];
  }
  if (attitude_.is_quaternion()) {
    for (const double angle : attitude_.angles(signals, t_)) {
      values_[column++] = angle;
    }
  }
  for (const std::size_t axis : axes_) {
    values_[column++] = acceleration_[axis];
  }
}

template <typename Value>
double PoseWindow::mean_of(const SignalHistory& signal, Interpolation between, Value value) const {
  const double end_s = t_ + pose_.half_s;
  double from_s = t_ - pose_.half_s;
  const std::size_t after = signal.first_after(from_s);
  if (after == 0) {
    return kNoValue;
  }
  double sum = 0.0;
  double before = PoseKernel::integral(-1.0);
  for (std::size_t i = after - 1; i < signal.size() && from_s < end_s; ++i) {
    const bool has_next = i + 1 < signal.size();
    const double next_s = has_next ? signal.time_s(i + 1) : end_s;
    const double until_s = std::min(next_s, end_s);
    if (next_s - signal.time_s(i) > gap_s_ || (between != Interpolation::hold && !has_next)) {
      return kNoValue;
    }
    double here = value(signal.value(i));
    if (between != Interpolation::hold) {
      const double share =
          (0.5 * (from_s + until_s) - signal.time_s(i)) / (next_s - signal.time_s(i));
      here += share * (value(signal.value(i + 1)) - here);
    }
    const double now = PoseKernel::integral((until_s - t_) / pose_.half_s);
    sum += (now - before) * here;
    before = now;
    from_s = until_s;
  }
  return sum;
}

double PoseWindow::mean(const SignalHistory& signal, Interpolation between) const {
  return mean_of(signal, between, [](double value) { return value; });
}

double PoseWindow::mean_angle(const SignalHistory& signal) const {
  const std::size_t after = signal.first_after(t_);
  if (after == 0) {
    return kNoValue;
  }
  // Around the angle in the middle, so that the jump from π to −π lies far away.
  const double middle = signal.value(after - 1);
  const double mean =
      mean_of(signal, Interpolation::line, [&](double angle) { return wrapped(angle - middle); });
  return wrapped(middle + mean);
}

}  // namespace kelpie
