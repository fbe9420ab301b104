// SPDX-License-Identifier: Apache-2.0
#include "chart/ticks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "chart/wording.hpp"

namespace kelpie::chart {
namespace {

constexpr double kHuge = 1e300;  // beyond it the length of a range could overflow

// Rounding in low / step must not lose a tick that lies on the edge.
constexpr double kEdge = 1e-9;

std::string with_minus(const std::string& number, bool negative) {
  return negative ? "−" + number : number;
}

std::string tick_label(double value, double step) {
  const bool negative = value < -0.5 * step;
  const double size = std::abs(value) < 0.5 * step ? 0.0 : std::abs(value);
  const double steps = size / step;
  if (step < 1e-5 || (size >= 1e7 && steps <= 1e4) || size >= 1e15) {
    const int digits = std::clamp(static_cast<int>(std::log10(steps + 1.0)) + 2, 2, 15);
    return with_minus(fmt::format("{:.{}g}", size, digits), negative);
  }
  if (step >= 1.0) {
    return with_minus(grouped(std::llround(size)), negative);
  }
  const int decimals = static_cast<int>(std::ceil(-std::log10(step) - kEdge));
  return with_minus(fmt::format("{:.{}f}", size, decimals), negative);
}

// Multiples of `step` from first to last, both counted from 0.
struct Multiples {
  double first = 0.0;
  double last = 0.0;
};

Multiples multiples_in(Extent range, double step) {
  return {std::ceil(range.low / step - kEdge), std::floor(range.high / step + kEdge)};
}

// Counting, not dividing lengths, so that a range between two round numbers still gets a tick.
double nice_step(Extent range, int most) {
  const double power = std::pow(10.0, std::floor(std::log10((range.high - range.low) / most)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    const Multiples inside = multiples_in(range, factor * power);
    if (inside.last - inside.first < most) {
      return factor * power;
    }
  }
  return 10.0 * power;
}

std::vector<Tick> decade_ticks(Extent range, std::span<const double> factors, int stride) {
  std::vector<Tick> ticks;
  const int first = static_cast<int>(std::floor(std::log10(range.low)));
  const int last = static_cast<int>(std::ceil(std::log10(range.high)));
  for (int decade = first; decade <= last; ++decade) {
    for (const double factor : factors) {
      const double value = factor * std::pow(10.0, decade);
      if (decade % stride == 0 && value >= range.low * (1.0 - kEdge) &&
          value <= range.high * (1.0 + kEdge)) {
        ticks.push_back({value, tick_label(value, std::pow(10.0, decade))});
      }
    }
  }
  return ticks;
}

}  // namespace

Extent range_of(std::span<const double> values) {
  bool any = false;
  Extent range;
  for (const double value : values) {
    if (std::isfinite(value)) {
      range = any ? Extent{std::min(range.low, value), std::max(range.high, value)}
                  : Extent{value, value};
      any = true;
    }
  }
  return range;
}

Extent widened(Extent range, double margin) {
  const double low = std::clamp(range.low, -kHuge, kHuge);
  const double high = std::clamp(range.high, -kHuge, kHuge);
  const double size = std::max(std::abs(low), std::abs(high));
  // A length below the resolution of double precision can't carry ticks that differ.
  if (high - low <= 1e-12 * size || high - low < 1e-300) {
    const double room = size > 1e-290 ? 0.1 * size : 1.0;
    return {low - room, high + room};
  }
  return {low - margin * (high - low), high + margin * (high - low)};
}

std::vector<Tick> linear_ticks(Extent range, int most) {
  const double step = nice_step(range, most);
  const Multiples inside = multiples_in(range, step);
  std::vector<Tick> ticks;
  for (int k = 0; inside.first + k <= inside.last; ++k) {
    const double value = (inside.first + k) * step;
    ticks.push_back({value, tick_label(value, step)});
  }
  return ticks;
}

std::vector<Tick> logarithmic_ticks(Extent range, int most) {
  constexpr std::array kAll = {1.0, 2.0, 5.0};
  std::vector<Tick> ticks = decade_ticks(range, kAll, 1);
  const std::span<const double> powers = std::span(kAll).first(1);
  for (int stride = 1; ticks.size() > static_cast<std::size_t>(most); ++stride) {
    ticks = decade_ticks(range, powers, stride);
  }
  return ticks;
}

Scale::Scale(Extent data, Extent pixels, ScaleKind kind)
    : data_(data), pixels_(pixels), kind_(kind) {
  if (kind_ == ScaleKind::logarithmic) {
    data_ = {std::log10(data.low), std::log10(data.high)};
  }
}

double Scale::operator()(double value) const {
  const double place = kind_ == ScaleKind::linear ? value
                       : value > 0.0              ? std::log10(value)
                                                  : data_.low;
  const double share = (place - data_.low) / (data_.high - data_.low);
  return pixels_.low + std::clamp(share, 0.0, 1.0) * (pixels_.high - pixels_.low);
}

}  // namespace kelpie::chart
