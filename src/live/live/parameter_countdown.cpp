// SPDX-License-Identifier: Apache-2.0
#include "live/parameter_countdown.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/seconds.hpp"
#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "live/tuning.hpp"
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

}  // namespace

ParameterCountdown::ParameterCountdown(const Configuration& configuration,
                                       const ParameterSettings& settings)
    : settings_(settings),
      columns_(study::planar_columns(without_rows(configuration),
                                     configuration.settings.shared.states, settings.thrusters)),
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
  identified_s_ = t;
  const std::size_t before = known();
  identify();
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

void ParameterCountdown::identify() {
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
  return fmt::format("{} of {} parameters known to ± {:g} %; least known: {} ({})", known(),
                     found_.size(), settings_.percent, least->name,
                     std::isnan(least->interval)
                         ? std::string("not told")
                         : fmt::format("± {:.1f} %", 100.0 * least->interval));
}

}  // namespace kelpie::live
