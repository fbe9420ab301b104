// SPDX-License-Identifier: Apache-2.0
#include "live/parameter_countdown.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/seconds.hpp"
#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "live/tuning.hpp"
#include "motion/states.hpp"
#include "study/drive_plan.hpp"

namespace kelpie::live {
namespace {

// What a log of the live rows would be called.
log::Dataset without_rows(const Configuration& configuration) {
  log::Dataset data;
  data.source = configuration.file;
  data.input_names = configuration.plan.inputs;
  data.target_names = configuration.plan.targets;
  return data;
}

// Names of parameters and thrusters are checked before the vehicle drives.
void require_names(const ParameterSettings& settings, const std::vector<std::string>& thrusters) {
  PlanarFit unknown;
  unknown.parameters = planar_parameters(thrusters);
  study::wanted_places(unknown, settings.tell);
  for (const auto& [name, value] : settings.thrust) {
    require_name("--thrust", name, "thruster", thrusters);
  }
}

study::PlanarColumns columns_of(const Configuration& configuration,
                                const std::vector<std::string>& thrusters) {
  const log::Dataset data = without_rows(configuration);
  const std::string& states = configuration.settings.shared.states;
  try {
    return study::planar_columns(data, states, thrusters);
  } catch (const InputError& error) {
    const auto leaves_plane = [&](std::size_t state) {
      constexpr std::array<std::optional<std::size_t>, 3> kOut{2, 3, 4};  // heave, roll, pitch
      return std::ranges::count(kOut, velocity_axis(data.input_names[state])) > 0;
    };
    if (!std::ranges::any_of(find_states(states, data.input_names, data.target_names.size()),
                             leaves_plane)) {
      throw;
    }
    throw InputError("--tell",
                     std::string("identifies vehicles in the plane; six axes are identified from a "
                                 "recording, by kelpie identify --vehicle FILE (") +
                         error.what() + ")");
  }
}

// "40 s", "3 min".
std::string duration_text(double seconds) {
  constexpr double kMinute = 60.0;
  constexpr double kTens = 10.0;
  return seconds < 2.0 * kMinute ? fmt::format("{:.0f} s", kTens * std::ceil(seconds / kTens))
                                 : fmt::format("{:.0f} min", std::ceil(seconds / kMinute));
}

}  // namespace

ParameterCountdown::ParameterCountdown(const Configuration& configuration,
                                       const ParameterSettings& settings)
    : settings_(settings),
      columns_(columns_of(configuration, settings.thrusters)),
      rate_hz_(configuration.plan.rate_hz),
      identified_s_(-std::numeric_limits<double>::infinity()) {
  for (const std::size_t thruster : columns_.thrusters) {
    rows_.thrusters.push_back(configuration.plan.inputs[thruster]);
  }
  require_names(settings_, rows_.thrusters);
  begin_anew();
}

std::size_t ParameterCountdown::rows_in(double seconds) const {
  return static_cast<std::size_t>(std::ceil(seconds * rate_hz_));
}

void ParameterCountdown::begin_anew() {
  PlanarRows none;
  none.thrusters = std::move(rows_.thrusters);
  none.starts.clear();
  rows_ = std::move(none);
  found_.clear();
  past_.clear();
  reason_ = "no rows so far";
}

void ParameterCountdown::update(std::span<const double> x, double t, bool changed, Output& output) {
  if (changed) {
    begin_anew();
  }
  keep(x, t);
  if (std::abs(t - identified_s_) < kTuning.between_identifications_s) {
    return;
  }
  const std::size_t before = known();
  identify(t);
  if (known() != before) {
    output.event(fmt::format("at {:.1f} s: {}", t, text()));
  }
}

void ParameterCountdown::keep(std::span<const double> x, double t) {
  const bool follows = rows_.rows() > 0 && t > rows_.times_s.back() &&
                       t - rows_.times_s.back() <= kLongestStep / rate_hz_;
  study::add_row(rows_, x, t, columns_, follows);
  if (rows_.rows() > rows_in(kTuning.identified_s + kTuning.forgotten_s)) {
    forget_oldest(rows_in(kTuning.forgotten_s));
  }
}

void ParameterCountdown::forget_oldest(std::size_t gone) {
  const auto erase = [gone](auto& values, std::size_t each) {
    values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(each * gone));
  };
  erase(rows_.times_s, 1);
  erase(rows_.velocities, kPlanarAxes);
  erase(rows_.speeds, rows_.thrusters.size());
  for (std::size_t& start : rows_.starts) {
    start -= std::min(start, gone);
  }
  const auto [again, end] = std::ranges::unique(rows_.starts);
  rows_.starts.erase(again, end);
}

void ParameterCountdown::identify(double t) {
  if (t < identified_s_) {
    past_.clear();
  } else if (!found_.empty()) {
    past_.push_back({.t = identified_s_, .found = std::move(found_)});
  }
  while (!past_.empty() && past_.front().t < t - kTuning.told_by_s) {
    past_.pop_front();
  }
  identified_s_ = t;
  found_.clear();
  try {
    PlanarFit fit = fit_planar(rows_);
    if (!settings_.thrust.empty()) {
      scale_by_thrust(fit, settings_.thrust);
    }
    for (const std::size_t place : study::wanted_places(fit, settings_.tell)) {
      const FittedParameter& parameter = fit.parameters[place];
      found_.push_back({.name = parameter.name});
      if (parameter.state == ParameterState::identified) {
        found_.back().value = parameter.value;
        found_.back().interval = study::interval_share(fit, place);
      }
    }
  } catch (const InputError& error) {
    reason_ = error.what();
  }
}

// Until the interval is as asked, by the information, 1 / interval², that the last minute brought.
// NaN: it brought none.
double ParameterCountdown::remaining_s(std::size_t place) const {
  const auto information = [](double interval) { return 1.0 / (interval * interval); };
  if (past_.empty() || past_.front().found.size() != found_.size()) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const double now = information(found_[place].interval);
  const double before = information(past_.front().found[place].interval);
  const double passed_s = identified_s_ - past_.front().t;
  const double rate = (now - before) / passed_s;
  return rate > 0.0 && passed_s >= 0.5 * kTuning.told_by_s
             ? (information(settings_.percent / 100.0) - now) / rate
             : std::numeric_limits<double>::quiet_NaN();
}

void ParameterCountdown::report(LearnerHealth& health) const {
  health.parameters = found_;
  health.parameters_known = known();
  health.countdown = text();
}

std::size_t ParameterCountdown::known() const {
  return static_cast<std::size_t>(std::ranges::count_if(found_, [&](const ParameterHealth& one) {
    return one.interval <= settings_.percent / 100.0;
  }));
}

std::string ParameterCountdown::text() const {
  if (found_.empty()) {
    return "parameters are not told yet: " + reason_;
  }
  const auto least = std::ranges::max_element(found_, {}, [](const ParameterHealth& one) {
    return std::isnan(one.interval) ? std::numeric_limits<double>::infinity() : one.interval;
  });
  std::string how = std::isnan(least->interval)
                        ? std::string("not told")
                        : fmt::format("± {:.1f} %", 100.0 * least->interval);
  const double left_s = remaining_s(static_cast<std::size_t>(least - found_.begin()));
  if (left_s > 0.0 && left_s < kTuning.longest_forecast_s) {
    how += fmt::format(" → ± {:g} % in about {}", settings_.percent, duration_text(left_s));
  }
  return fmt::format("{} of {} parameters known to ± {:g} %; least known: {} ({})", known(),
                     found_.size(), settings_.percent, least->name, how);
}

}  // namespace kelpie::live
