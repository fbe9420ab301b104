// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "chart/figure.hpp"
#include "chart/page.hpp"
#include "chart/wording.hpp"
#include "report/rollout_report.hpp"
#include "report/rollout_views.hpp"

namespace kelpie::report {
namespace {

constexpr chart::PlotSize kPanel{400, 250};
constexpr chart::PlotSize kWide{820, 230};
constexpr double kLowestR2 = 0.5;
constexpr double kNinetyPercent = 1.645;

std::string unit_of(const study::OpenLoopResult& result, std::size_t state) {
  return result.units[state].empty() ? "the log's unit" : result.units[state];
}

chart::Panel horizon_panel(const study::OpenLoopResult& result, std::size_t state) {
  std::vector<double> seconds;
  for (const study::HorizonScore& horizon : result.scores.front().horizons) {
    seconds.push_back(horizon.seconds);
  }
  const chart::Extent range = chart::range_of(seconds);
  chart::Figure figure(
      kPanel,
      {"s after the start", {range.low / 1.2, range.high * 1.2}, chart::ScaleKind::logarithmic},
      {"R² of " + result.states[state], {kLowestR2, 1.0}},
      result.states[state] + ": R² of the velocity by horizon");
  bool clipped = false;
  for (std::size_t i = 0; i < result.scores.size(); ++i) {
    std::vector<chart::Point> points;
    for (const study::HorizonScore& horizon : result.scores[i].horizons) {
      points.push_back({horizon.seconds, horizon.r2[state]});
      clipped = clipped || horizon.r2[state] < kLowestR2;
    }
    figure.line(points, i, result.scores[i].name);
    figure.markers(points, i, "");
  }
  return {figure.svg(), clipped ? "What lies below 0.5 is drawn on the edge." : ""};
}

chart::Panel example_panel(const study::OpenLoopResult& result, std::size_t state,
                           chart::PlotSize size) {
  const study::Trajectory& path = result.example;
  std::vector<chart::Point> measured;
  std::vector<chart::Point> velocity;
  std::vector<chart::Point> low;
  std::vector<chart::Point> high;
  std::vector<double> all;
  for (std::size_t row = 0; row < path.time_s.size(); ++row) {
    const double t = path.time_s[row];
    const double half = kNinetyPercent * path.spread[state][row];
    measured.push_back({t, path.measured[state][row]});
    velocity.push_back({t, path.velocity[state][row]});
    low.push_back({t, velocity.back().y - half});
    high.push_back({t, velocity.back().y + half});
    all.insert(all.end(), {measured.back().y, low.back().y, high.back().y});
  }
  chart::Figure figure(size, {"s after the start", chart::range_of(path.time_s)},
                       {result.states[state] + " in " + unit_of(result, state),
                        chart::widened(chart::range_of(all), 0.04)},
                       result.states[state] + ": one rollout beside what was measured");
  figure.band(low, high, 1);
  figure.line(measured, 0, "measured");
  figure.line(velocity, 1, "rolled out, 90 % band");
  return {figure.svg(), ""};
}

}  // namespace

std::string rollout_html(const study::OpenLoopResult& result) {
  std::string body = "<h1>In open loop</h1>\n" + chart::paragraph("lead", rollout_method(result));
  body += "<h2>How good, how long</h2>\n<div class=\"grid-panels\">\n";
  for (std::size_t state = 0; state < result.states.size(); ++state) {
    body += chart::figure_of(horizon_panel(result, state));
  }
  body += "</div>\n";
  for (const chart::TextTable& table : rollout_tables(result)) {
    body += "<h3>" + chart::escape_markup(table.title) + "</h3>\n" +
            chart::html_table(table.head, table.rows);
  }
  if (!result.example.time_s.empty()) {
    body += "<h2>One rollout</h2>\n" +
            chart::paragraph("", fmt::format("The liveliest: from {:g} s of the log on. "
                                             "The band is that of a Gaussian error.",
                                             result.example_start_s));
    for (std::size_t state = 0; state < result.states.size(); ++state) {
      body += chart::figure_of(example_panel(result, state, kWide),
                               example_panel(result, state, kPanel));
    }
  }
  return chart::html_page("kelpie: in open loop", body);
}

}  // namespace kelpie::report
