// SPDX-License-Identifier: Apache-2.0
#include "report/rollout_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>

#include "chart/figure.hpp"
#include "chart/page.hpp"
#include "chart/wording.hpp"
#include "core/quantile.hpp"
#include "core/text.hpp"

namespace kelpie::report {
namespace {

std::string seconds_text(double seconds) {
  return fmt::format("{:g} s", seconds);
}

// R² of one state: a row per contender, a column per horizon.
chart::TextTable horizon_table(const study::OpenLoopResult& result, std::size_t state) {
  chart::TextTable table{"R² of " + result.states[state], {"after"}, {}};
  std::vector<std::string> starts{"starts"};
  for (const study::HorizonScore& horizon : result.scores.front().horizons) {
    table.head.push_back(seconds_text(horizon.seconds));
    starts.push_back(chart::grouped(horizon.starts));
  }
  for (const study::OpenLoopScore& score : result.scores) {
    std::vector<std::string>& row = table.rows.emplace_back(1, score.name);
    for (const study::HorizonScore& horizon : score.horizons) {
      row.push_back(chart::decimal(horizon.r2[state]));
    }
  }
  table.rows.push_back(std::move(starts));
  return table;
}

std::string unit_of(const study::OpenLoopResult& result, std::size_t state) {
  return result.units[state].empty() ? "the log's unit" : chart::unit_text(result.units[state]);
}

// A column per state, and more.
chart::TextTable table_by_state(const study::OpenLoopResult& result, const std::string& title,
                                const std::string& first) {
  chart::TextTable table{title, {first}, {}};
  for (std::size_t state = 0; state < result.states.size(); ++state) {
    table.head.push_back(result.states[state] + "\nin " + unit_of(result, state));
  }
  return table;
}

chart::TextTable spread_table(const study::OpenLoopResult& result) {
  chart::TextTable table =
      table_by_state(result, "The model's error (RMS) and its spread", "after");
  for (const std::string& state : result.states) {
    table.head.push_back(state + " within\n90 % band");
  }
  table.head.emplace_back("left known\nground");
  for (const study::HorizonScore& horizon : result.scores.front().horizons) {
    std::vector<std::string>& row = table.rows.emplace_back(1, seconds_text(horizon.seconds));
    std::ranges::transform(horizon.rms, std::back_inserter(row), chart::significant);
    std::ranges::transform(horizon.covered, std::back_inserter(row), chart::decimal);
    row.push_back(chart::decimal(horizon.beyond));
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
      chart::safe_text(result.model), chart::safe_text(result.source), chart::grouped(result.rows),
      result.split, chart::grouped(result.stretches),
      result.stretches == 1 ? "stretch" : "stretches",
      result.held ? "are held" : "go along a line");
}

std::vector<chart::TextTable> rollout_tables(const study::OpenLoopResult& result) {
  std::vector<chart::TextTable> tables;
  for (std::size_t state = 0; state < result.states.size(); ++state) {
    tables.push_back(horizon_table(result, state));
  }
  tables.push_back(spread_table(result));
  if (!result.scores.front().reckoning.empty()) {
    tables.push_back(reckoning_table(result));
  }
  return tables;
}

namespace {

constexpr double kLowestDrawn = 0.5;

constexpr double kHeadlineS = 10.0;

// The longest of the horizons that have starts, at most ten seconds where one is as short.
std::size_t headline_horizon(const study::OpenLoopResult& result) {
  const std::vector<study::HorizonScore>& horizons = result.scores.front().horizons;
  std::size_t best = 0;
  for (std::size_t i = 1; i < horizons.size(); ++i) {
    best = horizons[i].starts > 0 && horizons[i].seconds <= kHeadlineS ? i : best;
  }
  return best;
}

// "surge" for u, where a name is that of a body axis.
std::string word_for(const std::string& state) {
  constexpr std::array<std::pair<char, const char*>, 6> kWords{{{'u', "surge"},
                                                                {'v', "sway"},
                                                                {'w', "heave"},
                                                                {'p', "roll rate"},
                                                                {'q', "pitch rate"},
                                                                {'r', "yaw rate"}}};
  const auto* const found = std::ranges::find_if(
      kWords, [&](const auto& word) { return state.size() == 1 && state.front() == word.first; });
  return found == kWords.end() ? state : found->second;
}

std::string headline(const study::OpenLoopResult& result) {
  const study::HorizonScore& horizon = result.scores.front().horizons[headline_horizon(result)];
  if (horizon.starts == 0) {
    return "No unbroken stretch of rows is as long as " + seconds_text(horizon.seconds);
  }
  std::vector<std::string> errors;
  for (std::size_t state = 0; state < result.states.size(); ++state) {
    errors.push_back(fmt::format("{} {}{:.2g}{}", word_for(result.states[state]),
                                 state == 0 ? "is within " : "", horizon.rms[state],
                                 result.units[state].empty() ? "" : " " + unit_of(result, state)));
  }
  return "After " + seconds_text(horizon.seconds) + " " + chart::list_text(errors);
}

// Who is closer to the measured velocities in every state; empty where nobody is.
std::string closer_sentence(const study::OpenLoopResult& result) {
  const std::size_t horizon = headline_horizon(result);
  const std::vector<double>& own = result.scores.front().horizons[horizon].rms;
  std::vector<std::string> closer;
  for (const study::OpenLoopScore& score : result.scores) {
    if (std::ranges::equal(score.horizons[horizon].rms, own, std::less<>{})) {
      closer.push_back(score.name);
    }
  }
  return closer.empty() ? "" : "Closer in every velocity: " + join_text(closer, "; ") + ".";
}

// The errors at the horizon of the headline, of every contender.
chart::TextTable contenders_table(const study::OpenLoopResult& result) {
  const std::size_t horizon = headline_horizon(result);
  const study::HorizonScore& model = result.scores.front().horizons[horizon];
  chart::TextTable table = table_by_state(result, {}, "RMS error");
  for (const study::OpenLoopScore& score : result.scores) {
    std::vector<std::string>& row = table.rows.emplace_back(1, score.name);
    std::ranges::transform(score.horizons[horizon].rms, std::back_inserter(row),
                           chart::significant);
  }
  table.notes = {fmt::format(
      "Root mean square errors {} after {} starts. {:.0f} % of the rollouts left the range of rows "
      "that the model has seen.",
      seconds_text(model.seconds), chart::grouped(model.starts), 100.0 * model.beyond)};
  return table;
}

std::string horizon_figure(const study::OpenLoopResult& result, std::size_t state) {
  chart::Figure figure({"time after the start in s", {}, chart::ScaleKind::logarithmic},
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
    half.push_back(kNormal90 * path.spread[state][row]);
  }
  chart::Figure figure({"time after the start in s"},
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
  const std::string closer = closer_sentence(result);
  return chart::html_page("kelpie: rollout",
                          chart::paragraph("over", "The model rolled out by its own velocities") +
                              chart::heading(1, headline(result) + ".") +
                              (closer.empty() ? "" : chart::paragraph("lead", closer)) +
                              chart::html_table(contenders_table(result)) +
                              chart::paragraph("note", rollout_method(result)),
                          {{"One rollout", example},
                           {"How the error grows", chart::panels(horizons)},
                           {"All figures", chart::html_tables(rollout_tables(result)), true}});
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
