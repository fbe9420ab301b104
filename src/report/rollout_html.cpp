// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "chart/figure.hpp"
#include "chart/page.hpp"
#include "chart/wording.hpp"
#include "report/rollout_report.hpp"

namespace kelpie::report {
namespace {

constexpr double kLowestDrawn = 0.5;
constexpr double kNinetyPercent = 1.645;

std::string unit_of(const study::OpenLoopResult& result, std::size_t state) {
  return result.units[state].empty() ? "the log's unit" : result.units[state];
}

std::string horizon_figure(const study::OpenLoopResult& result, std::size_t state) {
  chart::Figure figure({"s after the start", {}, chart::ScaleKind::logarithmic},
                       {"R² of " + result.states[state], chart::Extent{kLowestDrawn, 1.0}},
                       result.states[state] + ": R² of the velocity by horizon");
  bool clipped = false;
  for (std::size_t i = 0; i < result.scores.size(); ++i) {
    std::vector<chart::Point> points;
    for (const study::HorizonScore& horizon : result.scores[i].horizons) {
      points.push_back({horizon.seconds, horizon.r2[state]});
      clipped = clipped || horizon.r2[state] < kLowestDrawn;
    }
    figure.line(points, i, result.scores[i].name);
  }
  return figure.html(clipped ? "What lies below 0.5 is in the table alone." : "");
}

std::string example_figure(const study::OpenLoopResult& result, std::size_t state) {
  const study::Trajectory& path = result.example;
  std::vector<chart::Point> measured;
  std::vector<chart::Point> velocity;
  std::vector<double> half;
  for (std::size_t row = 0; row < path.time_s.size(); ++row) {
    measured.push_back({path.time_s[row], path.measured[state][row]});
    velocity.push_back({path.time_s[row], path.velocity[state][row]});
    half.push_back(kNinetyPercent * path.spread[state][row]);
  }
  chart::Figure figure({"s after the start"},
                       {result.states[state] + " in " + unit_of(result, state)},
                       result.states[state] + ": one rollout beside what was measured");
  figure.link("rollout");
  figure.band(velocity, half, 1, "90 % band");
  figure.line(measured, 0, "measured");
  figure.line(velocity, 1, "rolled out");
  return figure.html();
}

}  // namespace

std::string rollout_html(const study::OpenLoopResult& result) {
  std::vector<std::string> horizons;
  std::string example;
  for (std::size_t state = 0; state < result.states.size(); ++state) {
    horizons.push_back(horizon_figure(result, state));
    example += result.example.time_s.empty() ? "" : example_figure(result, state);
  }
  if (!example.empty()) {
    example = chart::paragraph("", fmt::format("The liveliest: from {:g} s of the log on. The band "
                                               "is that of a Gaussian error.",
                                               result.example_start_s)) +
              example;
  }
  return chart::html_page(
      "kelpie: in open loop",
      chart::heading(1, "In open loop") + chart::paragraph("lead", rollout_method(result)),
      {{"How good, how long", chart::panels(horizons)},
       {"One rollout", example},
       {"All figures", chart::html_tables(rollout_tables(result))}});
}

}  // namespace kelpie::report
