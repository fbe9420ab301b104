// SPDX-License-Identifier: Apache-2.0
// What of a SampleStream has to do with frames: signs, attitudes, lever arm.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "kelpie/stream/sample_stream.hpp"

namespace kelpie {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr double kDegree = std::numbers::pi / 180.0;

}  // namespace

// Converting a vector is the same for each of its samples, a sign and a place per component; so the
// components needn't wait for each other.
void SampleStream::route_vectors() {
  for (const StreamPlan::Vector& vector : plan_.vectors) {
    if (!vector.attitude.empty()) {
      continue;
    }
    const std::vector<Route> before = routes_;
    for (std::size_t from = 0; from < 3; ++from) {
      Triple unit{};
      unit[from] = 1.0;
      const Triple image = converted(unit, vector.from, vector.to);
      const std::size_t source = plan_.source(vector.columns[from]);
      const auto to = static_cast<std::size_t>(
          std::ranges::find_if(image, [](double part) { return part != 0.0; }) - image.begin());
      for (std::size_t k = 0; k < before.size(); ++k) {
        if (before[k].to == source) {
          routes_[k] = {.to = plan_.source(vector.columns[to]), .sign = before[k].sign * image[to]};
        }
      }
    }
  }
}

void SampleStream::use_arm() {
  if (!plan_.lever_arm) {
    return;
  }
  arm_.arm_m = plan_.lever_arm->arm_m;
  for (std::size_t part = 0; part < 3; ++part) {
    arm_.velocity[part] = plan_.source(plan_.lever_arm->velocity[part]);
    arm_.rates[part] = plan_.source(plan_.lever_arm->rates[part]);
    arm_.waiting.emplace_back(plan_.sources[arm_.velocity[part]].keep);
  }
}

void SampleStream::use_turns() {
  for (const StreamPlan::Vector& vector : plan_.vectors) {
    if (vector.attitude.empty()) {
      continue;
    }
    Turn& turn = turns_.emplace_back();
    turn.from = vector.from;
    turn.to = vector.to;
    turn.unit = vector.is_in_degrees ? kDegree : 1.0;
    for (std::size_t part = 0; part < 3; ++part) {
      turn.velocity[part] = plan_.source(vector.columns[part]);
      turn.waiting.emplace_back(plan_.sources[turn.velocity[part]].keep);
    }
    for (const std::string& name : vector.attitude) {
      turn.attitude.push_back(plan_.source(name));
    }
  }
}

Heard SampleStream::take(std::size_t source, double stamp_s, double value) {
  for (Turn& turn : turns_) {
    const auto* const part = std::ranges::find(turn.velocity, source);
    if (part != turn.velocity.end()) {
      SampleQueue& queue = turn.waiting[static_cast<std::size_t>(part - turn.velocity.begin())];
      if (queue.is_full()) {
        drop_first(turn);
      }
      queue.push({.stamp_s = stamp_s, .value = value});
      return std::isfinite(value) ? Heard::used : Heard::no_value;
    }
  }
  return take_of_body(source, stamp_s, value);
}

Heard SampleStream::take_of_body(std::size_t source, double stamp_s, double value) {
  for (std::size_t part = 0; part < arm_.waiting.size(); ++part) {
    if (arm_.velocity[part] == source && std::isfinite(value)) {
      SampleQueue& queue = arm_.waiting[part];
      if (queue.is_full()) {
        settle_first(part);
      }
      queue.push({.stamp_s = stamp_s, .value = value});
      return Heard::used;
    }
  }
  return signals_[source].add(stamp_s, value);
}

void SampleStream::settle_arm() {
  const auto are_known = [&](double stamp_s) {
    return std::ranges::all_of(arm_.rates, [&](std::size_t rate) {
      return is_known(rate, stamp_s - signals_[rate].lag_s(), Between::line);
    });
  };
  for (std::size_t part = 0; part < arm_.waiting.size(); ++part) {
    while (!arm_.waiting[part].is_empty() && are_known(arm_.waiting[part].front().stamp_s)) {
      settle_first(part);
    }
  }
}

void SampleStream::settle_first(std::size_t part) {
  const SampleQueue::Sample sample = arm_.waiting[part].pop();
  Triple rates{};
  for (std::size_t i = 0; i < 3; ++i) {
    const SignalHistory& rate = signals_[arm_.rates[i]];
    rates[i] = rate.at(sample.stamp_s - rate.lag_s(), Between::line);
  }
  Triple velocity{};
  velocity[part] = sample.value;
  signals_[arm_.velocity[part]].add(sample.stamp_s,
                                    without_lever_arm(velocity, rates, arm_.arm_m)[part]);
}

// Between two samples an angle goes the short way round.
Triple SampleStream::body_of(const Turn& turn, const Triple& vector, double stamp_s) const {
  std::array<double, 4> before{};
  std::array<double, 4> step{};
  double share = 0.0;
  for (std::size_t i = 0; i < turn.attitude.size(); ++i) {
    const SignalHistory& signal = signals_[turn.attitude[i]];
    const double t = stamp_s - signal.lag_s();
    before[i] = signal.at(t, Between::line);
    const std::size_t after = signal.first_after(t);
    if (std::isfinite(before[i]) && after > 0 && after < signal.size()) {
      const double begin_s = signal.time_s(after - 1);
      before[i] = signal.value(after - 1);
      step[i] = signal.value(after) - before[i];
      share = (t - begin_s) / (signal.time_s(after) - begin_s);
    }
    if (turn.attitude.size() == 3) {
      before[i] = turn.unit * before[i] +
                  share * std::remainder(turn.unit * step[i], 2.0 * std::numbers::pi);
    }
  }
  if (turn.attitude.size() == 3) {
    return in_body(vector, Triple{before[0], before[1], before[2]});
  }
  double along = 0.0;  // a quaternion and its opposite are one attitude
  for (std::size_t i = 0; i < before.size(); ++i) {
    along += before[i] * (before[i] + step[i]);
  }
  for (std::size_t i = 0; i < before.size(); ++i) {
    const double next = along < 0.0 ? -(before[i] + step[i]) : before[i] + step[i];
    before[i] += share * (next - before[i]);
  }
  return in_body(vector, before);
}

// All three are of one message; where one is missing, the others are nothing.
void SampleStream::settle_turns() {
  for (Turn& turn : turns_) {
    while (std::ranges::none_of(turn.waiting, &SampleQueue::is_empty)) {
      const double stamp_s =
          std::max({turn.waiting[0].front().stamp_s, turn.waiting[1].front().stamp_s,
                    turn.waiting[2].front().stamp_s});
      const bool is_whole = std::ranges::all_of(
          turn.waiting, [&](const SampleQueue& one) { return one.front().stamp_s == stamp_s; });
      if (!is_whole) {
        drop_first(turn);
        continue;
      }
      const bool is_ready = std::ranges::all_of(turn.attitude, [&](std::size_t source) {
        return is_known(source, stamp_s - signals_[source].lag_s(), Between::line);
      });
      if (!is_ready) {
        break;
      }
      Triple vector{};
      for (std::size_t part = 0; part < 3; ++part) {
        vector[part] = turn.waiting[part].pop().value;
      }
      vector = body_of(turn, vector, stamp_s);
      vector = converted(vector, turn.from == Frame::ned ? Frame::frd : Frame::flu, turn.to);
      for (std::size_t part = 0; part < 3; ++part) {
        take_of_body(turn.velocity[part], stamp_s, vector[part]);
      }
    }
  }
}

void SampleStream::drop_first(Turn& turn) {
  double first_s = std::numeric_limits<double>::infinity();
  for (const SampleQueue& queue : turn.waiting) {
    first_s = queue.is_empty() ? first_s : std::min(first_s, queue.front().stamp_s);
  }
  for (std::size_t part = 0; part < 3; ++part) {
    if (!turn.waiting[part].is_empty() && turn.waiting[part].front().stamp_s == first_s) {
      turn.waiting[part].pop();
      signals_[turn.velocity[part]].add(first_s, kMissing);
    }
  }
}

}  // namespace kelpie
