// SPDX-License-Identifier: Apache-2.0
#include "kelpie/report/rollout_report.hpp"

#include <fmt/format.h>

#include "json_parts.hpp"
#include "kelpie/report/wording.hpp"
#include "rollout_views.hpp"

namespace kelpie {
namespace {

Json horizon_json(const HorizonScore& score) {
  return {{"seconds", score.seconds},          {"starts", score.starts},
          {"r2", numbers(score.r2)},           {"rms", numbers(score.rms)},
          {"covered", numbers(score.covered)}, {"beyond", number(score.beyond)}};
}

Json reckoning_json(const ReckoningScore& score) {
  return {{"seconds", score.seconds},
          {"outages", score.outages},
          {"median", number(score.median)},
          {"p95", number(score.most)}};
}

Json score_json(const OpenLoopScore& score) {
  return {{"name", score.name},
          {"horizons", list(score.horizons, horizon_json)},
          {"dead_reckoning", list(score.reckoning, reckoning_json)}};
}

}  // namespace

std::string rollout_table(const OpenLoopResult& result) {
  std::string text = wrapped(rollout_method(result)) + "\n\n";
  for (const TextTable& table : rollout_tables(result)) {
    text += table_text(table);
  }
  return text;
}

std::string rollout_json(const OpenLoopResult& result) {
  return json_text({{"format", "kelpie-rollout"},
                    {"version", 1},
                    {"log", result.source},
                    {"model", result.model},
                    {"split", result.split},
                    {"rows", result.rows},
                    {"stretches", result.stretches},
                    {"fade_s", number(result.fade_s)},
                    {"commands", result.held ? "held" : "linear"},
                    {"states", result.states},
                    {"units", result.units},
                    {"scores", list(result.scores, score_json)}});
}

Table trajectory_table(const Trajectory& path, const std::vector<std::string>& states) {
  Table table;
  const auto add = [&](const std::string& name, const std::vector<double>& values) {
    table.names.push_back(name);
    table.columns.push_back(values);
  };
  add("t_s", path.time_s);
  for (std::size_t state = 0; state < states.size(); ++state) {
    add(states[state], path.velocity[state]);
    add(states[state] + "_spread", path.spread[state]);
    if (!path.measured[state].empty()) {
      add(states[state] + "_measured", path.measured[state]);
    }
  }
  add("beyond", {path.beyond.begin(), path.beyond.end()});
  table.lines.resize(path.time_s.size());
  return table;
}

}  // namespace kelpie
