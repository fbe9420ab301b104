// SPDX-License-Identifier: Apache-2.0
#include "format/rollout_json.hpp"

#include "file/json.hpp"

namespace kelpie::format {
namespace {

file::Json horizon_json(const study::HorizonScore& score) {
  return {{"seconds", score.seconds},
          {"starts", score.starts},
          {"r2", file::numbers(score.r2)},
          {"rms", file::numbers(score.rms)},
          {"covered", file::numbers(score.covered)},
          {"beyond", file::number(score.beyond)}};
}

file::Json reckoning_json(const study::ReckoningScore& score) {
  return {{"seconds", score.seconds},
          {"outages", score.outages},
          {"median", file::number(score.median)},
          {"p95", file::number(score.most)}};
}

file::Json score_json(const study::OpenLoopScore& score) {
  return {{"name", score.name},
          {"horizons", file::list(score.horizons, horizon_json)},
          {"dead_reckoning", file::list(score.reckoning, reckoning_json)}};
}

}  // namespace

std::string rollout_json(const study::OpenLoopResult& result) {
  return file::json_text({{"format", "kelpie-rollout"},
                          {"version", 1},
                          {"log", result.source},
                          {"model", result.model},
                          {"split", result.split},
                          {"rows", result.rows},
                          {"stretches", result.stretches},
                          {"commands", result.held ? "held" : "linear"},
                          {"states", result.states},
                          {"units", result.units},
                          {"scores", file::list(result.scores, score_json)}});
}

log::Table trajectory_table(const study::Trajectory& path, const std::vector<std::string>& states) {
  log::Table table;
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

}  // namespace kelpie::format
