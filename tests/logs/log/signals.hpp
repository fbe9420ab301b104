// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "kelpie/stream/signal_history.hpp"
#include "log/signal.hpp"

namespace kelpie::testing {

/// A signal of `f` at `rate_hz` over [from_s, to_s]; what f has at t is stamped t + late_s.
inline log::Signal signal_of(const std::string& name, const std::function<double(double)>& f,
                             double rate_hz, double from_s, double to_s, double late_s = 0.0) {
  log::Signal signal;
  signal.name = name;
  signal.from = "/" + name + ":x";
  signal.topic = "/" + name;
  const auto steps = std::lround(std::floor((to_s - from_s) * rate_hz + 1e-6));
  for (long k = 0; k <= steps; ++k) {
    const double t = from_s + static_cast<double>(k) / rate_hz;
    signal.times_s.push_back(t + late_s);
    signal.values.push_back(f(t));
  }
  return signal;
}

/// All of its samples, with silences of a second.
inline SignalHistory history_of(const log::Signal& signal) {
  SignalHistory history(signal.values.size(), 0.0, 1.0);
  for (std::size_t k = 0; k < signal.values.size(); ++k) {
    history.add(signal.times_s[k], signal.values[k]);
  }
  return history;
}

/// A vehicle with drag, u' = n|n| − 2u − u|u| for n = port and sway likewise for n = side, moved
/// exactly enough (Euler, 1 ms) at any time asked for.
class Vehicle {
 public:
  static double port(double t) { return std::sin(0.9 * t) + 0.6 * std::sin(2.3 * t + 1.0); }
  static double side(double t) { return std::cos(1.3 * t) + 0.5 * std::sin(3.1 * t); }

  explicit Vehicle(double until_s) {
    double u = 0.0;
    double v = 0.0;
    const auto steps = std::lround(until_s / kStep);
    for (long k = 0; k <= steps; ++k) {
      const double t = kStep * static_cast<double>(k);
      u_.push_back(u);
      v_.push_back(v);
      u += kStep * acceleration(port(t), u);
      v += kStep * acceleration(side(t), v);
    }
  }

  double u(double t) const { return u_.at(static_cast<std::size_t>(std::lround(t / kStep))); }
  double v(double t) const { return v_.at(static_cast<std::size_t>(std::lround(t / kStep))); }
  double udot(double t) const { return acceleration(port(t), u(t)); }

 private:
  static constexpr double kStep = 1e-3;
  static double acceleration(double n, double v) {
    return n * std::abs(n) - 2.0 * v - v * std::abs(v);
  }
  std::vector<double> u_;
  std::vector<double> v_;
};

}  // namespace kelpie::testing
