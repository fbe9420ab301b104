// SPDX-License-Identifier: Apache-2.0
#include "report/rollout_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "chart/figure.hpp"
#include "chart/page.hpp"
#include "chart/wording.hpp"
#include "core/text.hpp"

namespace kelpie::report {
namespace {

std::string seconds_text(double seconds) {
  return fmt::format("{:g} s", seconds);
}

// "0.963 / 0.910 / 0.949".
std::string by_state(const std::vector<double>& values) {
  std::vector<std::string> texts;
  texts.reserve(values.size());
  for (const double value : values) {
    texts.push_back(chart::decimal(value));
  }
  return join_text(texts, " / ");
}

chart::TextTable horizon_table(const study::OpenLoopResult& result) {
  chart::TextTable table{
      "R² of velocity, " + join_text(result.states, " / "), {"so long after"}, {}};
  for (const study::HorizonScore& horizon : result.scores.front().horizons) {
    table.head.push_back(seconds_text(horizon.seconds));
  }
  std::vector<std::string> starts{"starts"};
  for (const study::HorizonScore& horizon : result.scores.front().horizons) {
    starts.push_back(chart::grouped(horizon.starts));
  }
  table.rows.push_back(starts);
  for (const study::OpenLoopScore& score : result.scores) {
    std::vector<std::string> row{score.name};
    for (const study::HorizonScore& horizon : score.horizons) {
      row.push_back(by_state(horizon.r2));
    }
    table.rows.push_back(row);
  }
  return table;
}

chart::TextTable spread_table(const study::OpenLoopResult& result) {
  chart::TextTable table{
      "The model's error and its spread, " + join_text(result.states, " / "),
      {"so long after", "error, RMS (log's units)", "within the 90 % band", "left known ground"},
      {}};
  for (const study::HorizonScore& horizon : result.scores.front().horizons) {
    std::vector<std::string> errors;
    errors.reserve(horizon.rms.size());
    for (const double error : horizon.rms) {
      errors.push_back(chart::significant(error));
    }
    table.rows.push_back({seconds_text(horizon.seconds), join_text(errors, " / "),
                          by_state(horizon.covered), chart::decimal(horizon.beyond)});
  }
  return table;
}

chart::TextTable reckoning_table(const study::OpenLoopResult& result) {
  chart::TextTable table{
      "Dead reckoning without surge and sway, yaw rate measured: position error over "
      "distance, median (95 %)",
      {"outage"},
      {}};
  std::vector<std::string> outages{"outages"};
  for (const study::ReckoningScore& score : result.scores.front().reckoning) {
    table.head.push_back(seconds_text(score.seconds));
    outages.push_back(chart::grouped(score.outages));
  }
  table.rows.push_back(outages);
  for (const study::OpenLoopScore& score : result.scores) {
    std::vector<std::string> row{score.name};
    for (const study::ReckoningScore& one : score.reckoning) {
      row.push_back(chart::decimal(one.median) + " (" + chart::decimal(one.most) + ")");
    }
    table.rows.push_back(row);
  }
  return table;
}

}  // namespace

std::string rollout_method(const study::OpenLoopResult& result) {
  return fmt::format(
      "{} in open loop on {}: {} rows ({}) in {} unbroken {}, a start every second. "
      "Between two rows the commands {}.",
      chart::printable(result.model), chart::printable(result.source), chart::grouped(result.rows),
      result.split, chart::grouped(result.stretches),
      result.stretches == 1 ? "stretch" : "stretches",
      result.held ? "are held" : "go along a line");
}

std::vector<chart::TextTable> rollout_tables(const study::OpenLoopResult& result) {
  std::vector<chart::TextTable> tables{horizon_table(result), spread_table(result)};
  if (!result.scores.front().reckoning.empty()) {
    tables.push_back(reckoning_table(result));
  }
  return tables;
}

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
                                               "is that of nine in ten errors in practice.",
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

std::string rollout_table(const study::OpenLoopResult& result) {
  std::string text = chart::wrapped(rollout_method(result)) + "\n\n";
  std::vector<chart::TextTable> tables = rollout_tables(result);
  for (chart::TextTable& table : tables) {
    table.whole = true;  // a cell holds a number for each state
    text += chart::table_text(table);
  }
  return text;
}

}  // namespace kelpie::report
