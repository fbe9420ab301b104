// SPDX-License-Identifier: Apache-2.0
#include "stream/derivative.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "kelpie/core/error.hpp"
#include "kelpie/core/setting.hpp"
#include "stream/tuning.hpp"

namespace kelpie {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr int kHighestDegree = 4;
constexpr double kRounding = stream::kTuning.window_rounding_s;

}  // namespace

double DerivativeSettings::back_s() const {
  return window == FilterWindow::centred ? window_s / 2.0 : window_s;
}

double DerivativeSettings::ahead_s() const {
  return window == FilterWindow::centred ? window_s / 2.0 : 0.0;
}

void DerivativeSettings::validate() const {
  require_range("window", window_s,
                {.low = 0.0, .high = stream::kTuning.longest_window_s, .open = true});
  require_range("degree", degree, {.low = 1.0, .high = kHighestDegree});
}

SlopeWeights::SlopeWeights(std::size_t most) : weights_(most), polynomial_(most), before_(most) {}

std::span<const double> SlopeWeights::at(std::span<const double> offsets_s, int degree) {
  const std::size_t points = offsets_s.size();
  const auto parts_of = [&](std::vector<double>& all) { return std::span(all).first(points); };
  const std::span<double> weights = parts_of(weights_);
  std::span<double> p = parts_of(polynomial_);
  std::span<double> below = parts_of(before_);
  // In units of the window the powers stay near 1.
  double scale = 0.0;
  for (const double offset : offsets_s) {
    scale = std::max(scale, std::abs(offset));
  }
  std::ranges::fill(weights, 0.0);
  std::ranges::fill(p, 1.0);
  std::ranges::fill(below, 0.0);
  // Value and slope at t of the polynomial and of the one below it.
  double value = 1.0;
  double slope = 0.0;
  double value_below = 0.0;
  double slope_below = 0.0;
  auto squares = static_cast<double>(points);
  double squares_below = std::numeric_limits<double>::infinity();
  for (int k = 0; k < degree; ++k) {
    double moment = 0.0;
    for (std::size_t i = 0; i < points; ++i) {
      moment += offsets_s[i] / scale * p[i] * p[i];
    }
    const double centre = moment / squares;
    const double share = squares / squares_below;
    for (std::size_t i = 0; i < points; ++i) {
      below[i] = (offsets_s[i] / scale - centre) * p[i] - share * below[i];
    }
    std::swap(p, below);
    value_below = std::exchange(value, -centre * value - share * value_below);
    slope_below = std::exchange(slope, value_below - centre * slope - share * slope_below);
    squares_below = std::exchange(squares, std::inner_product(p.begin(), p.end(), p.begin(), 0.0));
    for (std::size_t i = 0; i < points; ++i) {
      weights[i] += p[i] * slope / (squares * scale);
    }
  }
  return weights;
}

DerivativeInfo derivative_info(double period_s, const DerivativeSettings& settings) {
  const auto steps = [&](double seconds) {
    return static_cast<std::int64_t>(std::floor(seconds / period_s + kRounding));
  };
  std::vector<double> offsets;
  for (std::int64_t k = -steps(settings.back_s()); k <= steps(settings.ahead_s()); ++k) {
    offsets.push_back(static_cast<double>(k) * period_s);
  }
  if (offsets.size() <= static_cast<std::size_t>(settings.degree)) {
    throw InputError("window", number_text(settings.window_s) + " s hold " +
                                   std::to_string(offsets.size()) + " samples of a signal with " +
                                   number_text(1.0 / period_s) + " Hz; a polynomial of degree " +
                                   std::to_string(settings.degree) + " takes " +
                                   std::to_string(settings.degree + 1) + " or more");
  }
  SlopeWeights filter(offsets.size());
  const std::span<const double> weights = filter.at(offsets, settings.degree);
  DerivativeInfo info{.points = weights.size()};
  double squares = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    info.delay_s -= 0.5 * weights[i] * offsets[i] * offsets[i];
    squares += weights[i] * weights[i];
  }
  info.delay_s = std::abs(info.delay_s) < kRounding ? 0.0 : info.delay_s;
  info.noise_gain = std::sqrt(squares);
  return info;
}

Derivative::Derivative(const DerivativeSettings& settings, double gap_s, std::size_t most)
    : settings_(settings), gap_s_(gap_s), offsets_s_(most), weights_(most) {}

double Derivative::at(const SignalHistory& signal, double t) {
  const double back = t - settings_.back_s();
  const double ahead = t + settings_.ahead_s();
  const std::size_t end = signal.first_after(ahead + kRounding);
  std::size_t first = end;
  for (; first > 0 && signal.time_s(first - 1) >= back - kRounding; --first) {
    if (first < end && signal.time_s(first) - signal.time_s(first - 1) > gap_s_) {
      return kNone;
    }
    offsets_s_[first - 1] = signal.time_s(first - 1) - t;
  }
  const std::size_t points = end - first;
  if (points <= static_cast<std::size_t>(settings_.degree)) {
    return kNone;
  }
  const double step =
      (signal.time_s(end - 1) - signal.time_s(first)) / static_cast<double>(points - 1);
  if (!reaches_back(signal, first, back, step) || !reaches_ahead(signal, end, ahead, step)) {
    return kNone;
  }
  const std::span<const double> weights =
      weights_.at(std::span(offsets_s_).subspan(first, points), settings_.degree);
  double slope = 0.0;
  for (std::size_t i = 0; i < points; ++i) {
    slope += weights[i] * signal.value(first + i);
  }
  return slope;
}

// Beyond the window's edge the signal goes on, or the edge is as good as reached.
bool Derivative::reaches_back(const SignalHistory& signal, std::size_t first, double edge,
                              double step) const {
  const bool goes_on = first > 0 && signal.time_s(first) - signal.time_s(first - 1) <= gap_s_;
  return goes_on || signal.time_s(first) <= edge + step + kRounding;
}

// A causal window must not ask for what comes next: a sample missed is all it may be behind.
bool Derivative::reaches_ahead(const SignalHistory& signal, std::size_t end, double edge,
                               double step) const {
  if (settings_.window == FilterWindow::causal) {
    return signal.time_s(end - 1) >= edge - stream::kTuning.causal_steps * step - kRounding;
  }
  const bool goes_on = end < signal.size() && signal.time_s(end) - signal.time_s(end - 1) <= gap_s_;
  return goes_on || signal.time_s(end - 1) >= edge - step - kRounding;
}

}  // namespace kelpie
