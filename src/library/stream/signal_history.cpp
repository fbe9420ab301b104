// SPDX-License-Identifier: Apache-2.0
#include "kelpie/stream/signal_history.hpp"

#include <algorithm>
#include <cmath>
#include <ranges>

#include "kelpie/core/error.hpp"
#include "stream/tuning.hpp"

namespace kelpie {

SignalHistory::SignalHistory(std::size_t keep, double lag_s, double gap_s)
    : lag_s_(lag_s), gap_s_(gap_s), times_s_(keep), values_(keep) {
  require(keep > 0, "keep", "has to be one sample or more");
}

SignalVerdict SignalHistory::add(double stamp_s, double value) {
  if (!std::isfinite(value)) {
    ++faults_.no_value;
    return SignalVerdict::no_value;
  }
  const double t = stamp_s - lag_s_;
  const std::size_t at = t > newest_s() ? size_ : first_after(t);
  if (at > 0 && time_s(at - 1) == t) {
    ++faults_.duplicates;
    return SignalVerdict::repeated;
  }
  if (t <= closed_s_ || (at == 0 && size_ == times_s_.size())) {
    ++faults_.late;
    return SignalVerdict::late;
  }
  if (at == size_) {
    note_in_order(stamp_s, value);
  } else {
    ++faults_.steps_back;
  }
  ++faults_.samples;
  insert(at, t, value);
  return SignalVerdict::used;
}

void SignalHistory::insert(std::size_t at, double t, double value) {
  if (size_ == times_s_.size()) {
    first_ = place(1);  // the oldest goes
    --at;
  } else {
    ++size_;
  }
  for (std::size_t i = size_ - 1; i > at; --i) {
    times_s_[place(i)] = times_s_[place(i - 1)];
    values_[place(i)] = values_[place(i - 1)];
  }
  times_s_[place(at)] = t;
  values_[place(at)] = value;
  begin_s_ = std::min(begin_s_, t);
}

void SignalHistory::note_in_order(double stamp_s, double value) {
  const double silence = size_ > 0 ? stamp_s - newest_stamp_s_ : 0.0;
  faults_.gaps += silence > gap_s_ ? 1 : 0;
  if (silence > faults_.longest_gap_s) {
    faults_.longest_gap_s = silence;
    faults_.longest_gap_at_s = newest_stamp_s_;
  }
  newest_stamp_s_ = stamp_s;
  if (stretch_samples_ == 0 || value != stretch_value_) {
    stretch_value_ = value;
    stretch_begin_s_ = stamp_s;
    stretch_samples_ = 0;
  }
  ++stretch_samples_;
  const double lasted = stamp_s - stretch_begin_s_;
  const bool is_stuck = stretch_samples_ >= stream::kTuning.stuck_samples && lasted > gap_s_;
  if (is_stuck && !stretch_counted_) {
    ++faults_.stuck;
  }
  stretch_counted_ = is_stuck;
  if (is_stuck) {
    stuck_begin_s_ = stretch_begin_s_ - lag_s_;
    stuck_end_s_ = stamp_s - lag_s_;
  }
  if (is_stuck && lasted > faults_.longest_stuck_s) {
    faults_.longest_stuck_s = lasted;
    faults_.longest_stuck_at_s = stretch_begin_s_;
  }
}

void SignalHistory::close(double t) {
  closed_s_ = std::max(closed_s_, t);
}

std::size_t SignalHistory::first_after(double t) const {
  const auto kept = std::views::iota(std::size_t{0}, size_);
  return *std::ranges::partition_point(kept, [&](std::size_t i) { return time_s(i) <= t; });
}

double SignalHistory::newest_s() const {
  return size_ > 0 ? time_s(size_ - 1) : kNever;
}

double SignalHistory::at(double t, Interpolation between) const {
  constexpr double kNotHeld = std::numeric_limits<double>::quiet_NaN();
  const std::size_t after = first_after(t);
  if (after == 0) {
    return kNotHeld;
  }
  const double before_s = time_s(after - 1);
  if (between == Interpolation::hold || before_s == t) {
    return t - before_s <= gap_s_ ? value(after - 1) : kNotHeld;
  }
  if (after == size_ || time_s(after) - before_s > gap_s_) {
    return kNotHeld;
  }
  if (between == Interpolation::curve) {
    return on_curve(t, after);
  }
  return std::lerp(value(after - 1), value(after), (t - before_s) / (time_s(after) - before_s));
}

// Hermite's polynomial between the samples before and after t.
double SignalHistory::on_curve(double t, std::size_t after) const {
  const auto slope = [&](std::size_t first, std::size_t last) {
    return (value(last) - value(first)) / (time_s(last) - time_s(first));
  };
  const auto joined = [&](std::size_t i) { return time_s(i) - time_s(i - 1) <= gap_s_; };
  const std::size_t first = after > 1 && joined(after - 1) ? after - 2 : after - 1;
  const std::size_t last = after + 1 < size_ && joined(after + 1) ? after + 1 : after;
  const double step_s = time_s(after) - time_s(after - 1);
  const double share = (t - time_s(after - 1)) / step_s;
  const double rise = value(after) - value(after - 1);
  const double bend_before = step_s * slope(first, after) - rise;
  const double bend_after = step_s * slope(after - 1, last) - rise;
  return value(after - 1) + share * rise +
         share * (1.0 - share) * ((1.0 - share) * bend_before - share * bend_after);
}

void SignalHistory::reset() {
  size_ = 0;
  begin_s_ = -kNever;
  newest_stamp_s_ = kNever;
  closed_s_ = kNever;
  stretch_samples_ = 0;
  stretch_counted_ = false;
  stuck_begin_s_ = -kNever;
  stuck_end_s_ = kNever;
}

}  // namespace kelpie
