// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include "kelpie/core/random.hpp"
#include "study/result.hpp"

namespace kelpie::synthetic {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// The totals a learner could have after `samples` samples.
inline Status status_after(std::size_t samples) {
  const auto n = static_cast<std::int64_t>(samples);
  Status status;
  status.ready = true;
  status.kkt_gap = 5e-4;
  status.tally = {.accepted = n / 2,
                  .explained = n / 4,
                  .duplicate = n - n / 2 - n / 4,
                  .invalid = 0,
                  .outliers = n / 100,
                  .forgotten = n / 50,
                  .released = n / 20,
                  .rejected_by_tolerance = 0};
  status.buffer = static_cast<int>(n / 2 - n / 100 - n / 50 - n / 20);
  status.support_vectors = status.buffer * 3 / 4;
  return status;
}

/// One axis after `samples` samples at 4 Hz, a validation point after every 50th, `held_out` rows.
inline study::AxisResult axis(const std::string& name, std::size_t samples, std::size_t held_out) {
  RandomStream random(1, name);
  study::AxisResult axis;
  axis.name = name;
  for (std::size_t n = 1; n <= samples; ++n) {
    axis.update_us.push_back(std::exp(5.7 + 0.7 * random.normal()));
    if (n % 50 == 0) {
      const auto place = static_cast<double>(n);
      const double r2 = 0.95 - std::exp(-place / 300.0) + 0.01 * random.normal();
      axis.validation.push_back({n, 0.25 * place, r2, 1, status_after(n)});
    }
  }
  for (std::size_t row = 0; row < held_out; ++row) {
    const double time = 0.25 * static_cast<double>(row);
    axis.held_out_time_s.push_back(time);
    axis.held_out_true.push_back(0.05 * std::sin(time / 4.0));
    axis.held_out_predicted.push_back(axis.held_out_true.back() + 0.004 * random.normal());
  }
  axis.r2_final = 0.951;
  axis.r2_mean = 0.902;
  axis.r2_min_after_1000 = samples < 1000 ? kNan : 0.853;
  axis.prequential_r2 = 0.974;
  axis.corrected_r2 = 0.991;
  axis.status = status_after(samples);
  return axis;
}

/// A stream over `axes` axes that ran to its end.
inline study::StreamResult stream(std::size_t axes, std::size_t samples = 2000) {
  const std::size_t held_out = samples / 4;
  study::StreamResult result;
  result.source = "logs/dive_7.csv";
  result.rows_read = samples + held_out + 3;
  result.rows_skipped = 3;
  result.rate_hz = 4.0;
  result.input_names = {"u", "v", "r", "th1", "th2", "th3"};
  result.split = "blocks of 400 rows, every 5th held out";
  result.scales = "first 200 samples";
  result.seed = 7;
  result.training_rows = samples;
  result.held_out_rows = held_out;
  result.samples_shown = samples;
  result.settings = {{"buffer", "900"}, {"gamma", "0.1,0.25,0.5"}, {"solver", "path"}};
  for (std::size_t i = 0; i < axes; ++i) {
    result.axes.push_back(axis("axis" + std::to_string(i), samples, held_out));
  }
  return result;
}

/// The same with two physics terms, from the third validation point on: damping that stays, and
/// thrust that falls to half in the middle of the stream, where the configuration becomes 2; th2 is
/// named for it.
inline study::StreamResult stream_with_terms(std::size_t axes, std::size_t samples = 2000) {
  study::StreamResult result = stream(axes, samples);
  for (study::AxisResult& axis : result.axes) {
    axis.unit = "m s^-2";
    axis.terms = {{"u*|u|", "m^-1", 0.25}, {"max(th1,0)^2", "m rev^-2", 40.0}};
    for (std::size_t i = 2; i < axis.validation.size(); ++i) {
      const bool later = axis.validation[i].samples > samples / 2;
      axis.validation[i].configuration = later ? 2 : 1;
      axis.validation[i].coefficients = {-0.8, later ? 0.001 : 0.002};
      axis.validation[i].errors = {0.05, 1e-4};
    }
  }
  Finding finding;
  finding.since_s = 120.0;
  finding.found_s = finding.told_s = 131.0;
  finding.state = FindingState::named;
  finding.count = 1;
  finding.causes[0] = {CauseKind::thruster, 4, 0.48, 0.41, 0.55};
  finding.rival = {CauseKind::load, 0, 1.4, 1.2, 1.6};
  finding.evidence = 900.0;
  finding.margin = 250.0;
  finding.explained = 0.98;
  result.diagnosis.findings = {finding};
  result.diagnosis.health = {{CauseKind::thruster, 3, 1.01, 0.97, 1.05}};
  return result;
}

/// A stream stopped before anything was measured.
inline study::StreamResult stopped_at_once() {
  study::StreamResult result = stream(1, 20);
  study::AxisResult& axis = result.axes.front();
  result.training_rows = 2000;
  result.interrupted = true;
  axis.r2_final = axis.r2_mean = axis.prequential_r2 = axis.corrected_r2 = kNan;
  axis.held_out_predicted.assign(axis.held_out_true.size(), kNan);
  axis.status = Status{};
  return result;
}

}  // namespace kelpie::synthetic
