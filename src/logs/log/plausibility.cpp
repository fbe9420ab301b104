// SPDX-License-Identifier: Apache-2.0
#include "log/plausibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>
#include <utility>

#include "core/quantile.hpp"
#include "kelpie/motion/attitude.hpp"
#include "kelpie/motion/unit.hpp"
#include "log/command_clock.hpp"
#include "log/pair_moments.hpp"
#include "log/tuning.hpp"
#include "motion/states.hpp"

namespace kelpie::log {
namespace {

constexpr const auto& kLimits = kTuning.plausibility;
constexpr double kGravity = 9.81;  // m/s²

// How a target goes with the slope of a velocity over the same windows of time.
struct TargetCheck {
  std::string target;
  std::string velocity;
  double correlation = 0.0;  // of the target's means with the slopes
  double ratio = 1.0;        // standard deviation of the targets over that of the slopes, signed
  double offset = 0.0;  // mean of the targets beyond that of the slopes, in deviations of these
  double late_s = 0.0;  // shift of the target with the largest correlation [s]; 0: none
  std::string other{};  // the velocity whose acceleration the target is; "": this one
};

// A unit of a target or of its velocity, which explains a factor between the target and the slope
// of the velocity.
struct LikelyUnit {
  const char* unit;
  bool is_of_target;
  const char* what;  // {0}: the velocity, {1}: the target
};

constexpr std::array kUnits = std::to_array<LikelyUnit>({
    {"deg/s", false, "{0} is in degrees per second, {1} in rad/s²"},
    {"deg/s^2", true, "{1} is in degrees per second squared, {0} in rad/s"},
    {"cm/s", false, "{0} is in cm/s, {1} in m/s²"},
    {"cm/s^2", true, "{1} is in cm/s², {0} in m/s"},
    {"mm/s", false, "{0} is in mm/s, {1} in m/s²"},
    {"g", true, "{1} is in g, {0} in m/s"},
    {"km/h", false, "{0} is in km/h, {1} in m/s²"},
    {"knots", false, "{0} is in knots, {1} in m/s²"},
});

// A unit of time stamps, which all targets share.
struct KnownClock {
  double ratio;
  const char* unit;
};
constexpr std::array kClocks =
    std::to_array<KnownClock>({{1e3, "ms"}, {1e6, "µs"}, {1e9, "ns"}, {1.0 / 60.0, "min"}});

bool near(double one, double other) {
  return std::abs(std::log(one / other)) <= std::log1p(kLimits.near);
}

bool is_plain(double ratio) {
  return ratio >= kLimits.least_ratio && ratio <= kLimits.most_ratio;
}

// Pairs of slopes of a velocity and means of a target over windows without a gap; with an angle
// pairs of the angle's sine and the target's mean beyond the slope.
class Windows {
 public:
  Windows(const Dataset& data, std::size_t velocity, std::size_t target)
      : data_(data), velocity_(velocity), target_(target) {}

  /// Moments of the sine of an angle (an input, `unit` in rad) and the target beyond the slope.
  PairMoments beside_angle(std::size_t angle, double unit, std::size_t length) const {
    PairMoments moments;
    const auto step = static_cast<std::ptrdiff_t>(length);
    for (std::ptrdiff_t i = 0; i + step < std::ssize(data_.times_s); i += step) {
      const std::optional<double> x = slope(i, step);
      const std::optional<double> y = mean(i, step);
      const auto middle = static_cast<std::size_t>(i + step / 2);
      if (x && y) {
        moments.add(std::sin(unit * data_.input(middle)[angle]), *y - *x);
      }
    }
    return moments;
  }

  /// Moments of slopes and means for windows of `length` rows, the target read `late` rows later;
  /// empty for too few windows, or without motion.
  std::optional<PairMoments> compare(std::size_t length, std::ptrdiff_t late) const {
    PairMoments moments;
    const auto rows = static_cast<std::ptrdiff_t>(data_.rows());
    const auto step = static_cast<std::ptrdiff_t>(length);
    for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, -late);
         i + step + std::max<std::ptrdiff_t>(0, late) < rows; i += step) {
      const std::optional<double> x = slope(i, step);
      const std::optional<double> y = mean(i + late, step);
      if (x && y) {
        moments.add(*x, *y);
      }
    }
    if (moments.n < kLimits.least_windows || !moments.varies()) {
      return std::nullopt;
    }
    return moments;
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

  const Dataset& data_;
  std::size_t velocity_;
  std::size_t target_;
};

// Of standard deviations, with the sign of the correlation.
double ratio_of(const PairMoments& moments) {
  return std::copysign(std::sqrt(moments.yy / moments.xx), moments.xy);
}

std::size_t rows_in(double seconds, double rate_hz) {
  return static_cast<std::size_t>(std::max(1.0, std::round(seconds * rate_hz)));
}

// The shift that makes a target follow its velocity where the target as it stands does not, with
// this correlation.
void find_shift(const Windows& windows, std::size_t length, double rate_hz, double correlation,
                TargetCheck& check) {
  const auto most = static_cast<std::ptrdiff_t>(rows_in(kLimits.most_late_s, rate_hz));
  const auto step = static_cast<std::ptrdiff_t>(rows_in(kLimits.late_step_s, rate_hz));
  double best = std::max(kLimits.late_correlation, std::abs(correlation) + kLimits.late_gain);
  for (std::ptrdiff_t late = -most; late <= most; late += step) {
    const auto found = windows.compare(length, late);
    if (found && found->correlation() > best && is_plain(ratio_of(*found))) {
      best = found->correlation();
      check.late_s = static_cast<double>(late) / rate_hz;
    }
  }
}

std::optional<TargetCheck> check_target(const Dataset& data, std::size_t velocity,
                                        std::size_t target) {
  TargetCheck check{.target = data.target_names[target], .velocity = data.input_names[velocity]};
  const Windows windows(data, velocity, target);
  const auto length_of = [&](double seconds) {
    return std::max(kLimits.least_rows, rows_in(seconds, data.rate_hz));
  };
  bool measured = false;
  for (const double seconds : kLimits.windows_s) {
    const auto found = windows.compare(length_of(seconds), 0);
    if (found && std::abs(found->correlation()) > std::abs(check.correlation)) {
      check.correlation = found->correlation();
      check.ratio = ratio_of(*found);
      check.offset = (found->mean_y - found->mean_x) / std::sqrt(found->xx / found->n);
      measured = true;
    }
  }
  // Long windows hide a shift of a second or two.
  const std::size_t shortest = length_of(kLimits.windows_s.front());
  const auto in_short = windows.compare(shortest, 0);
  if (in_short && std::abs(in_short->correlation()) < kLimits.unrelated) {
    find_shift(windows, shortest, data.rate_hz, in_short->correlation(), check);
  }
  for (std::size_t input = 0; input < data.input_names.size(); ++input) {
    const bool may_be_its = std::abs(check.correlation) < kLimits.unrelated && input != velocity &&
                            velocity_axis(data.input_names[input]);
    const auto found =
        may_be_its ? Windows(data, input, target).compare(shortest, 0) : std::nullopt;
    if (found && found->correlation() >= kLimits.least_correlation && is_plain(ratio_of(*found))) {
      check.other = data.input_names[input];
    }
  }
  return measured ? std::optional(check) : std::nullopt;
}

// Gravity in the acceleration of surge or sway, as an accelerometer measures it: the specific
// force.
std::optional<Mistake> gravity_mistake(const Dataset& data, std::size_t velocity,
                                       std::size_t target) {
  const Attitude attitude = find_attitude(data.input_names);
  const std::optional<std::size_t> axis = velocity_axis(data.input_names[velocity]);
  const std::optional<std::size_t> angle = axis == 0   ? attitude.pitch
                                           : axis == 1 ? attitude.roll
                                                       : std::nullopt;
  if (!angle) {
    return std::nullopt;
  }
  const std::size_t length =
      std::max(kLimits.least_rows, rows_in(kLimits.windows_s.front(), data.rate_hz));
  const PairMoments moments =
      Windows(data, velocity, target)
          .beside_angle(*angle, axis == 0 ? attitude.pitch_unit : attitude.roll_unit, length);
  const double slope = moments.varies() ? moments.xy / moments.xx : 0.0;
  if (moments.n < kLimits.least_windows ||
      std::abs(moments.correlation()) < kLimits.least_correlation ||
      !near(std::abs(slope), kGravity)) {
    return std::nullopt;
  }
  return Mistake{
      fmt::format("{} lies beside the slope of {} by {:.3g} m/s² times the sine of {}: a specific "
                  "force with gravity, as an accelerometer measures it",
                  data.target_names[target], data.input_names[velocity], slope,
                  data.input_names[*angle]),
      "take gravity off, or leave the accelerations out: slopes of the velocities do"};
}

// The input whose derivative the target is.
std::optional<std::size_t> velocity_of(const Dataset& data, std::span<const std::size_t> states,
                                       std::size_t target) {
  if (!states.empty()) {
    return states[target];
  }
  for (const std::string_view name : differentiated(data.target_names[target])) {
    const auto found = std::ranges::find(data.input_names, name);
    if (found != data.input_names.end()) {
      return static_cast<std::size_t>(found - data.input_names.begin());
    }
  }
  return std::nullopt;
}

bool shows_ratio(const TargetCheck& check) {
  return std::abs(check.correlation) >= kLimits.least_correlation;
}

// A factor that all targets share is the clock's.
std::optional<Mistake> clock_mistake(const Dataset& data, const std::vector<TargetCheck>& checks) {
  std::vector<double> ratios;
  for (const TargetCheck& check : checks) {
    if (shows_ratio(check)) {
      ratios.push_back(std::abs(check.ratio));
    }
  }
  if (ratios.empty()) {
    return std::nullopt;
  }
  const double ratio = quantile(ratios, 0.5);
  const bool certain = std::ranges::min(ratios) > kLimits.certain_clock;
  const bool shared = std::ranges::all_of(ratios, [&](double own) { return near(own, ratio); });
  // Of one target a small factor tells of units as well.
  if (!certain && (ratios.size() == 1 || !shared || is_plain(ratio))) {
    return std::nullopt;
  }
  const std::string why =
      fmt::format("all targets are {:.3g} times as large as the slopes of their velocities", ratio);
  for (const KnownClock& clock : kClocks) {
    const bool fits = certain ? std::abs(std::log(ratio / clock.ratio)) < std::log(kLimits.clock)
                              : near(ratio, clock.ratio);
    if (!data.time_column.empty() && fits) {
      return Mistake{
          fmt::format("time stamps are in {} ({})", clock.unit, why),
          fmt::format("--units {}={} converts the stamps", data.time_column, clock.unit)};
    }
  }
  return Mistake{
      fmt::format("{}: the log has {:.3g} times as many rows per second as said", why, ratio),
      fmt::format("--rate {:.3g} says so", data.rate_hz * ratio)};
}

std::optional<Mistake> unit_mistake(const TargetCheck& check) {
  const double ratio = std::abs(check.ratio);
  const std::string how_large = fmt::format("{} is {:.3g} times as large as the slope of {}",
                                            check.target, ratio, check.velocity);
  for (const LikelyUnit& likely : kUnits) {
    const double in_si = Unit::parse(likely.unit).in_si().second;
    if (near(ratio, likely.is_of_target ? 1.0 / in_si : in_si)) {
      const std::string what = fmt::format(fmt::runtime(likely.what), check.velocity, check.target);
      return Mistake{fmt::format("{} ({})", what, how_large),
                     fmt::format("--units {}={} converts",
                                 likely.is_of_target ? check.target : check.velocity, likely.unit)};
    }
  }
  // Filters of a vehicle at rest shrink targets, too.
  if (ratio >= kLimits.least_unknown && ratio <= kLimits.most_unknown) {
    return std::nullopt;
  }
  return Mistake{how_large + ": the two have different units",
                 fmt::format("--units {}=… converts to the SI", check.velocity)};
}

void add_mistakes_of(const TargetCheck& check, bool is_clock_right, std::vector<Mistake>& found) {
  if (check.late_s != 0.0) {
    found.push_back({fmt::format("{} comes {:.3g} s {} than {} changes: the two have different "
                                 "clocks",
                                 check.target, std::abs(check.late_s),
                                 check.late_s > 0.0 ? "later" : "earlier", check.velocity),
                     "take the acceleration from the velocity by [log.derived] "
                     "(docs/howto/logs.md), or shift the column"});
  }
  if (!check.other.empty()) {
    found.push_back({fmt::format("{} is the acceleration of {}, not of {}: columns are exchanged",
                                 check.target, check.other, check.velocity),
                     fmt::format("exchange the names of {} and {}", check.velocity, check.other)});
  }
  if (!shows_ratio(check)) {
    return;
  }
  if (is_clock_right && !is_plain(std::abs(check.ratio))) {
    if (auto unit = unit_mistake(check)) {
      found.push_back(*std::move(unit));
    }
  }
  if (std::abs(check.offset) > kLimits.most_offset) {
    found.push_back({fmt::format("{} lies {:.2g} standard deviations beside the slope of {} in the "
                                 "mean: a sensor that is tilted, or gravity?",
                                 check.target, check.offset, check.velocity),
                     "take its mean off, or leave the column out: slopes of the velocity do",
                     false});
  }
  if (check.ratio < 0.0) {
    found.push_back({fmt::format("{} has the sign opposite to the slope of {}: the axes of the two "
                                 "differ (NED and ENU, or FRD and FLU)",
                                 check.target, check.velocity),
                     fmt::format("change the sign of {} or of {}", check.target, check.velocity)});
  }
}

// Rows with the stamp of the row before.
std::optional<Mistake> repeated_stamps(const Dataset& data) {
  std::size_t count = 0;
  double first_s = 0.0;
  for (std::size_t row = 1; row < data.rows(); ++row) {
    if (data.times_s[row] == data.times_s[row - 1]) {
      first_s = count == 0 ? data.times_s[row] : first_s;
      ++count;
    }
  }
  if (count == 0) {
    return std::nullopt;
  }
  const bool often =
      static_cast<double>(count) > kLimits.most_repeated * static_cast<double>(data.rows());
  return Mistake{
      fmt::format("{} of {} rows have the time stamp of the row before, the first at {:g} s", count,
                  data.rows(), first_s),
      often ? "stamps are rounded or rows are repeated: give the rows per second by --rate, or "
              "remove the repeated rows"
            : "remove the repeated rows",
      often};
}

std::optional<Mistake> long_gap(const Dataset& data) {
  double longest_s = kLimits.longest_gap_s;
  std::optional<std::size_t> before;
  for (std::size_t row = 1; row < data.rows(); ++row) {
    const double gap_s = data.times_s[row] - data.times_s[row - 1];
    if (gap_s > longest_s && gap_s * data.rate_hz > kLimits.gap_rows) {
      longest_s = gap_s;
      before = row - 1;
    }
  }
  if (!before) {
    return std::nullopt;
  }
  return Mistake{
      fmt::format("no rows for {:.3g} min after {:g} s", longest_s / 60.0, data.times_s[*before]),
      "a vehicle that was changed meanwhile has to be learned anew from there: cut the "
      "log",
      false};
}

// Rows of a velocity that are far beyond all others, as those with a sensor's mark of no value.
std::optional<Mistake> absurd_values(const Dataset& data, std::size_t input) {
  std::vector<double> values;
  for (std::size_t row = 0; row < data.rows(); ++row) {
    values.push_back(data.input(row)[input]);
  }
  std::vector<double> sorted = values;
  const double middle = quantile(sorted, 0.5);
  std::vector<double> distances = values;
  std::ranges::for_each(distances, [&](double& value) { value = std::abs(value - middle); });
  const double usual = quantile(distances, 1.0 - kLimits.most_absurd);
  const auto is_absurd = [&](double value) {
    return std::abs(value - middle) > kLimits.absurd * usual;
  };
  const auto count = std::ranges::count_if(values, is_absurd);
  if (count == 0 || !(usual > 0.0)) {
    return std::nullopt;
  }
  const double worst =
      *std::ranges::max_element(values, {}, [&](double value) { return std::abs(value - middle); });
  return Mistake{fmt::format("{}: {} at {:g}, {:.0f} times as far from the median as all others",
                             data.input_names[input],
                             count == 1 ? "1 row" : fmt::format("{} rows, the farthest", count),
                             worst, std::abs(worst - middle) / usual),
                 "a sensor's mark of no value? Leave such cells empty", false};
}

std::vector<TargetCheck> check_targets(const Dataset& data, const std::string& states,
                                       std::vector<Mistake>& gravity) {
  const std::vector<std::size_t> found =
      find_states(states, data.input_names, data.target_names.size());
  std::vector<TargetCheck> checks;
  for (std::size_t target = 0; target < data.target_names.size(); ++target) {
    const bool is_derived = std::ranges::count(data.derived, data.target_names[target]) > 0;
    const auto velocity = is_derived ? std::nullopt : velocity_of(data, found, target);
    if (velocity) {
      if (const auto mistake = gravity_mistake(data, *velocity, target)) {
        gravity.push_back(*mistake);
      } else if (const auto check = check_target(data, *velocity, target)) {
        checks.push_back(*check);
      }
    }
  }
  return checks;
}

// A velocity beyond those of all vehicles, as in other units.
std::optional<Mistake> range_mistake(const Dataset& data, std::size_t input, std::size_t axis) {
  std::vector<double> sizes;
  for (std::size_t row = 0; row < data.rows(); ++row) {
    sizes.push_back(std::abs(data.input(row)[input]));
  }
  const bool is_turning = axis > 2;
  const double most = is_turning ? kLimits.fastest_turn_rad_s : kLimits.fastest_m_s;
  const double usual = quantile(sizes, kLimits.usual_size);
  if (usual <= most) {
    return std::nullopt;
  }
  const std::string& name = data.input_names[input];
  const bool is_certain = is_turning && usual > kLimits.certainly_too_fast * most;
  return Mistake{fmt::format("{0}{1} reaches {2:.3g} {3}, as of hardly any vehicle",
                             is_certain ? name + " is in degrees per second: " : "", name, usual,
                             is_turning ? "rad/s" : "m/s"),
                 fmt::format("--units {}={} converts other units, and its acceleration, too", name,
                             is_turning ? "deg/s" : "cm/s"),
                 is_certain};
}

}  // namespace

std::vector<Mistake> clock_mistakes(const Dataset& data) {
  std::vector<Mistake> found = data.doubts;
  for (std::size_t input = 0; input < data.input_names.size() && data.rows() > 0; ++input) {
    const std::optional<std::size_t> axis = velocity_axis(data.input_names[input]);
    for (const auto& mistake : {axis ? absurd_values(data, input) : std::nullopt,
                                axis ? range_mistake(data, input, *axis) : std::nullopt}) {
      if (mistake) {
        found.push_back(*mistake);
      }
    }
  }
  for (const auto& mistake : {repeated_stamps(data), long_gap(data)}) {
    if (mistake) {
      found.push_back(*mistake);
    }
  }
  if (data.rate_hz > kLimits.fastest_hz) {
    found.push_back({fmt::format("{:.4g} rows per second are more than a vehicle's motion has to "
                                 "tell",
                                 data.rate_hz),
                     "`kelpie inspect LOG --template log.toml` writes a configuration with a "
                     "lower rate, for --config log.toml",
                     false});
  }
  return found;
}

std::vector<Mistake> target_mistakes(const Dataset& data, const std::string& states,
                                     double align_s) {
  std::vector<Mistake> found;
  const std::vector<TargetCheck> checks = check_targets(data, states, found);
  const std::optional<Mistake> clock = clock_mistake(data, checks);
  if (clock) {
    found.push_back(*clock);
  }
  for (const TargetCheck& check : checks) {
    add_mistakes_of(check, !clock, found);
  }
  if (const auto late = command_clock_mistake(data, states, align_s)) {
    found.push_back(*late);
  }
  return found;
}

std::vector<Mistake> all_mistakes(const Dataset& data, const std::string& states) {
  std::vector<Mistake> found = target_mistakes(data, states);
  std::ranges::move(clock_mistakes(data), std::back_inserter(found));
  return found;
}

std::string mistake_text(const Mistake& mistake) {
  return mistake.what + "; " + mistake.remedy;
}

}  // namespace kelpie::log
