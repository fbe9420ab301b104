// SPDX-License-Identifier: Apache-2.0
#include "rollout_views.hpp"

#include <fmt/format.h>

#include "kelpie/core/text.hpp"
#include "kelpie/report/wording.hpp"

namespace kelpie {
namespace {

std::string seconds_text(double seconds) {
  return fmt::format("{:g} s", seconds);
}

// "0.963 / 0.910 / 0.949".
std::string by_state(const std::vector<double>& values) {
  std::vector<std::string> texts;
  for (const double value : values) {
    texts.push_back(decimal(value));
  }
  return join_text(texts, " / ");
}

TextTable horizon_table(const OpenLoopResult& result) {
  TextTable table{"R² of velocity, " + join_text(result.states, " / "), {"so long after"}, {}};
  for (const HorizonScore& horizon : result.scores.front().horizons) {
    table.head.push_back(seconds_text(horizon.seconds));
  }
  std::vector<std::string> starts{"starts"};
  for (const HorizonScore& horizon : result.scores.front().horizons) {
    starts.push_back(grouped(static_cast<std::int64_t>(horizon.starts)));
  }
  table.rows.push_back(starts);
  for (const OpenLoopScore& score : result.scores) {
    std::vector<std::string> row{score.name};
    for (const HorizonScore& horizon : score.horizons) {
      row.push_back(by_state(horizon.r2));
    }
    table.rows.push_back(row);
  }
  return table;
}

TextTable spread_table(const OpenLoopResult& result) {
  TextTable table{"The model's error and its spread, " + join_text(result.states, " / "),
                  {"so long after", "error, RMS", "within the 90 % band", "left known ground"},
                  {}};
  for (const HorizonScore& horizon : result.scores.front().horizons) {
    std::vector<std::string> errors;
    for (const double error : horizon.rms) {
      errors.push_back(significant(error));
    }
    table.rows.push_back({seconds_text(horizon.seconds), join_text(errors, " / "),
                          by_state(horizon.covered), decimal(horizon.beyond)});
  }
  return table;
}

TextTable reckoning_table(const OpenLoopResult& result) {
  TextTable table{
      "Dead reckoning without surge and sway, yaw rate measured: position error over "
      "distance, median (95 %)",
      {"outage"},
      {}};
  std::vector<std::string> outages{"outages"};
  for (const ReckoningScore& score : result.scores.front().reckoning) {
    table.head.push_back(seconds_text(score.seconds));
    outages.push_back(grouped(static_cast<std::int64_t>(score.outages)));
  }
  table.rows.push_back(outages);
  for (const OpenLoopScore& score : result.scores) {
    std::vector<std::string> row{score.name};
    for (const ReckoningScore& one : score.reckoning) {
      row.push_back(decimal(one.median) + " (" + decimal(one.most) + ")");
    }
    table.rows.push_back(row);
  }
  return table;
}

}  // namespace

std::string rollout_method(const OpenLoopResult& result) {
  return fmt::format(
      "{} in open loop on {}: {} rows ({}) in {} unbroken stretches, a start every second. "
      "Between two rows the commands {}.",
      printable(result.model), printable(result.source),
      grouped(static_cast<std::int64_t>(result.rows)), result.split,
      grouped(static_cast<std::int64_t>(result.stretches)),
      result.held ? "are held" : "go along a line");
}

std::vector<TextTable> rollout_tables(const OpenLoopResult& result) {
  std::vector<TextTable> tables{horizon_table(result), spread_table(result)};
  if (!result.scores.front().reckoning.empty()) {
    tables.push_back(reckoning_table(result));
  }
  return tables;
}

}  // namespace kelpie
