// SPDX-License-Identifier: Apache-2.0
#include "report/rollout_report.hpp"

#include <fmt/format.h>

#include "chart/wording.hpp"
#include "kelpie/core/text.hpp"

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
      {"so long after", "error, RMS", "within the 90 % band", "left known ground"},
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

}  // namespace kelpie::report
