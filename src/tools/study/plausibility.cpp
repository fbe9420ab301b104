// SPDX-License-Identifier: Apache-2.0
#include "study/plausibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include "core/quantile.hpp"
#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "motion/states.hpp"
#include "study/tuning.hpp"

namespace kelpie::study {
namespace {

constexpr const auto& kLimits = kTuning.plausibility;

/// A factor between a target and the slope of its velocity, and the mistake behind the factor.
struct KnownFactor {
  double ratio;
  const char* meaning;
};

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kGravity = 9.80665;
constexpr std::array kUnits = std::to_array<KnownFactor>({
    {kDegree, "{0} is in degrees per second, {1} in rad/s²: convert {0} to rad/s"},
    {1.0 / kDegree, "{1} is in degrees per second squared, {0} in rad/s: convert {1} to rad/s²"},
    {0.01, "{0} is in cm/s, {1} in m/s²: convert {0} to m/s"},
    {100.0, "{1} is in cm/s², {0} in m/s: convert {1} to m/s²"},
    {1e-3, "{0} is in mm/s, {1} in m/s²: convert {0} to m/s"},
    {1.0 / kGravity, "{1} is in g, {0} in m/s: multiply {1} by 9.81"},
    {1.0 / 3.6, "{0} is in km/h, {1} in m/s²: convert {0} to m/s"},
    {0.5144, "{0} is in knots, {1} in m/s²: convert {0} to m/s"},
});
constexpr std::array kClocks = std::to_array<KnownFactor>({
    {1e3, "time stamps are in ms: convert them to s"},
    {1e6, "time stamps are in µs: convert them to s"},
    {1e9, "time stamps are in ns: convert them to s"},
    {1.0 / 60.0, "time stamps are in minutes: convert them to s"},
});

bool near(double ratio, double known) {
  return std::abs(std::log(ratio / known)) <= std::log1p(kLimits.near);
}

bool is_plain(double ratio) {
  return ratio >= kLimits.least_ratio && ratio <= kLimits.most_ratio;
}

// Pairs of slopes of a velocity and means of a target over windows without a gap.
class Windows {
 public:
  Windows(const log::Dataset& data, std::size_t velocity, std::size_t target)
      : data_(data), velocity_(velocity), target_(target) {}

  /// Correlation and signed ratio for windows of `length` rows, the target read `late` rows later;
  /// empty for too few windows, or without motion.
  std::optional<std::pair<double, double>> compare(std::size_t length, std::ptrdiff_t late) const {
    double n = 0.0;
    double mean_x = 0.0;
    double mean_y = 0.0;
    double xx = 0.0;
    double yy = 0.0;
    double xy = 0.0;
    const auto rows = static_cast<std::ptrdiff_t>(data_.rows());
    const auto step = static_cast<std::ptrdiff_t>(length);
    for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, -late);
         i + step + std::max<std::ptrdiff_t>(0, late) < rows; i += step) {
      const std::optional<double> x = slope(i, step);
      const std::optional<double> y = mean(i + late, step);
      if (!x || !y) {
        continue;
      }
      n += 1.0;
      const double dx = *x - mean_x;
      const double dy = *y - mean_y;
      mean_x += dx / n;
      mean_y += dy / n;
      xx += dx * (*x - mean_x);
      yy += dy * (*y - mean_y);
      xy += dx * (*y - mean_y);
    }
    if (n < kLimits.least_windows || !(xx > 0.0) || !(yy > 0.0)) {
      return std::nullopt;
    }
    const double correlation = xy / std::sqrt(xx * yy);
    return std::pair(correlation, std::copysign(std::sqrt(yy / xx), correlation));
  }

 private:
  std::optional<double> span_s(std::ptrdiff_t first, std::ptrdiff_t step) const {
    const auto a = static_cast<std::size_t>(first);
    const auto b = static_cast<std::size_t>(first + step);
    const double seconds = data_.times_s[b] - data_.times_s[a];
    const double usual = static_cast<double>(step) / data_.rate_hz;
    const bool whole = seconds > 0.0 && seconds <= kLimits.longest_window * usual &&
                       data_.configurations[a] == data_.configurations[b];
    return whole ? std::optional(seconds) : std::nullopt;
  }

  std::optional<double> slope(std::ptrdiff_t first, std::ptrdiff_t step) const {
    const std::optional<double> seconds = span_s(first, step);
    const auto value = [&](std::ptrdiff_t row) {
      return data_.input(static_cast<std::size_t>(row))[velocity_];
    };
    return seconds ? std::optional((value(first + step) - value(first)) / *seconds) : std::nullopt;
  }

  std::optional<double> mean(std::ptrdiff_t first, std::ptrdiff_t step) const {
    if (!span_s(first, step)) {
      return std::nullopt;
    }
    const auto value = [&](std::ptrdiff_t row) {
      return data_.target(static_cast<std::size_t>(row))[target_];
    };
    double sum = 0.5 * (value(first) + value(first + step));
    for (std::ptrdiff_t row = first + 1; row < first + step; ++row) {
      sum += value(row);
    }
    return sum / static_cast<double>(step);
  }

  const log::Dataset& data_;
  std::size_t velocity_;
  std::size_t target_;
};

std::size_t rows_in(double seconds, double rate_hz) {
  return static_cast<std::size_t>(std::max(1.0, std::round(seconds * rate_hz)));
}

// The shift that makes a target follow its velocity where the target as it stands does not.
void find_shift(const Windows& windows, std::size_t length, double rate_hz, TargetCheck& check) {
  const auto most = static_cast<std::ptrdiff_t>(rows_in(kLimits.most_late_s, rate_hz));
  const auto step = static_cast<std::ptrdiff_t>(rows_in(kLimits.late_step_s, rate_hz));
  double best = kLimits.late_correlation;
  for (std::ptrdiff_t late = -most; late <= most; late += step) {
    const auto pair = windows.compare(length, late);
    if (pair && pair->first > best && is_plain(pair->second)) {
      best = pair->first;
      check.late_s = static_cast<double>(late) / rate_hz;
    }
  }
}

std::optional<TargetCheck> check_target(const log::Dataset& data, std::size_t velocity,
                                        std::size_t target) {
  TargetCheck check{.target = data.target_names[target], .velocity = data.input_names[velocity]};
  const Windows windows(data, velocity, target);
  bool measured = false;
  std::size_t shortest = 0;
  for (const double seconds : kLimits.windows_s) {
    const std::size_t length = std::max(kLimits.least_rows, rows_in(seconds, data.rate_hz));
    shortest = shortest == 0 ? length : shortest;
    const auto pair = windows.compare(length, 0);
    if (pair && std::abs(pair->first) > std::abs(check.correlation)) {
      std::tie(check.correlation, check.ratio) = *pair;
      measured = true;
    }
  }
  if (measured && std::abs(check.correlation) < kLimits.unrelated) {
    find_shift(windows, shortest, data.rate_hz, check);
  }
  return measured ? std::optional(check) : std::nullopt;
}

// The input whose derivative the target is.
std::optional<std::size_t> velocity_of(const log::Dataset& data,
                                       std::span<const std::size_t> states, std::size_t target) {
  if (!states.empty()) {
    return states[target];
  }
  const std::string& name = data.target_names[target];
  for (std::size_t i = 0; i < data.input_names.size(); ++i) {
    const std::string& input = data.input_names[i];
    if (name == input + "dot" || name == input + "_dot" || name == "d" + input) {
      return i;
    }
  }
  return std::nullopt;
}

bool shows_ratio(const TargetCheck& check) {
  return std::abs(check.correlation) >= kLimits.least_correlation;
}

// A factor that all targets share is the clock's.
std::string clock_mistake(const std::vector<TargetCheck>& checks) {
  std::vector<double> ratios;
  for (const TargetCheck& check : checks) {
    if (shows_ratio(check)) {
      ratios.push_back(std::abs(check.ratio));
    }
  }
  if (ratios.size() < 2) {
    return "";
  }
  const double ratio = quantile(ratios, 0.5);
  const bool shared = std::ranges::all_of(ratios, [&](double one) { return near(one, ratio); });
  if (!shared || is_plain(ratio)) {
    return "";
  }
  for (const KnownFactor& clock : kClocks) {
    if (near(ratio, clock.ratio)) {
      return fmt::format(
          "{} (all targets are {:.3g} times as large as the slopes of their "
          "velocities)",
          clock.meaning, ratio);
    }
  }
  return fmt::format(
      "all targets are {:.3g} times as large as the slopes of their velocities: the "
      "log has {:.3g} times as many rows per second as said",
      ratio, ratio);
}

std::string unit_mistake(const TargetCheck& check) {
  const double ratio = std::abs(check.ratio);
  for (const KnownFactor& unit : kUnits) {
    if (near(ratio, unit.ratio)) {
      return fmt::format("{} ({} is {:.3g} times as large as the slope of {})",
                         fmt::format(fmt::runtime(unit.meaning), check.velocity, check.target),
                         check.target, ratio, check.velocity);
    }
  }
  // Filters of a vehicle at rest shrink targets, too.
  if (ratio >= kLimits.least_unknown && ratio <= kLimits.most_unknown) {
    return "";
  }
  return fmt::format("{} is {:.3g} times as large as the slope of {}: the two have different units",
                     check.target, ratio, check.velocity);
}

}  // namespace

std::vector<TargetCheck> check_targets(const log::Dataset& data, const std::string& states) {
  const std::vector<std::size_t> found =
      find_states(states, data.input_names, data.target_names.size());
  std::vector<TargetCheck> checks;
  for (std::size_t target = 0; target < data.target_names.size(); ++target) {
    if (const auto velocity = velocity_of(data, found, target)) {
      if (const auto check = check_target(data, *velocity, target)) {
        checks.push_back(*check);
      }
    }
  }
  return checks;
}

std::vector<std::string> mistakes(const std::vector<TargetCheck>& checks) {
  std::vector<std::string> found;
  const std::string clock = clock_mistake(checks);
  if (!clock.empty()) {
    found.push_back(clock);
  }
  for (const TargetCheck& check : checks) {
    if (check.late_s != 0.0) {
      found.push_back(fmt::format("{} comes {:.3g} s {} than {} changes: its clock is another",
                                  check.target, std::abs(check.late_s),
                                  check.late_s > 0.0 ? "later" : "earlier", check.velocity));
    }
    if (!shows_ratio(check)) {
      continue;
    }
    const std::string unit =
        clock.empty() && !is_plain(std::abs(check.ratio)) ? unit_mistake(check) : "";
    if (!unit.empty()) {
      found.push_back(unit);
    }
    if (check.ratio < 0.0) {
      found.push_back(
          fmt::format("{} has the sign opposite to the slope of {}: the axes of the two "
                      "differ (NED and ENU, or FRD and FLU)",
                      check.target, check.velocity));
    }
  }
  return found;
}

void require_plausible(const log::Dataset& data, const std::string& states) {
  const std::vector<std::string> found = mistakes(check_targets(data, states));
  if (!found.empty()) {
    throw InputError({.file = data.source, .line = 0, .field = "targets"},
                     join_text(found, "; ") +
                         "; convert the columns, or learn the log as it stands with --accept "
                         "implausible");
  }
}

}  // namespace kelpie::study
