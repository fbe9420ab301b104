// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "kelpie/core/text.hpp"
#include "log/sampling.hpp"

namespace kelpie::log {
namespace {

// What is wrong, in words; empty when nothing is.
std::string faults_text(const SignalFaults& faults) {
  std::vector<std::string> parts;
  const auto add = [&](std::size_t count, const std::string& what) {
    if (count > 0) {
      parts.push_back(fmt::format("{} {}", count, what));
    }
  };
  add(faults.no_value, "without value");
  add(faults.duplicates, "with the stamp before");
  add(faults.steps_back, "out of order");
  if (faults.gaps > 0) {
    add(faults.gaps,
        fmt::format("silence{}, longest {:.2f} s at {:.1f} s", faults.gaps > 1 ? "s" : "",
                    faults.longest_gap_s, faults.longest_gap_at_s));
  }
  if (faults.stuck > 0) {
    add(faults.stuck, fmt::format("stretch{} of one value, longest {:.1f} s at {:.1f} s",
                                  faults.stuck > 1 ? "es" : "", faults.longest_stuck_s,
                                  faults.longest_stuck_at_s));
  }
  return join_text(parts, ", ");
}

std::string lag_text(const SamplingReport::OfSource& source) {
  return source.lag_origin.empty() ? "–" : fmt::format("{:.3f}", source.lag_s);
}

void add_lags(std::string& text, const SamplingReport& report) {
  if (report.lags) {
    text += fmt::format(
        "lags estimated from the first {} whole rows (up to {:.1f} s): they explain {:.1f} % of "
        "the accelerations, {:.1f} % without\n",
        report.lags->rows, report.lag_until_s, 100.0 * report.lags->explained,
        100.0 * report.lags->explained_at_zero);
    std::vector<std::string> common;
    for (const LagEstimate& topic : report.lags->topics) {
      if (!topic.is_own && report.lags->topics.size() > 1) {
        common.push_back(topic.topic);
      }
    }
    if (!common.empty()) {
      text +=
          "the common lag, for one of their own explained hardly more: " + join_text(common, ", ") +
          "\n";
    }
  }
}

}  // namespace

std::string sampling_text(const SamplingReport& report) {
  std::size_t width = 6;
  for (const SamplingReport::OfSource& source : report.sources) {
    width = std::max(width, source.name.size());
  }
  std::string text = fmt::format("{:<{}} {:>8} {:>8} {:>7}  found\n", "signal", width, "samples",
                                 "rate/Hz", "lag/s");
  for (const SamplingReport::OfSource& source : report.sources) {
    text +=
        fmt::format("{:<{}} {:>8} {:>8.2f} {:>7}  {}\n", source.name, width, source.faults.samples,
                    source.rate_hz, lag_text(source), faults_text(source.faults));
  }
  for (const SamplingReport::OfDerived& derived : report.derived) {
    text += fmt::format("{}: {} points, delay {:.3f} s, noise × {:.3g} /s\n", derived.name,
                        derived.info.points, derived.info.delay_s, derived.info.noise_gain);
  }
  add_lags(text, report);
  text += fmt::format("{} rows, {} whole in {} stretch{}\n", report.rows, report.whole_rows,
                      report.segments, report.segments == 1 ? "" : "es");
  return text;
}

}  // namespace kelpie::log
