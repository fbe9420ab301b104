// SPDX-License-Identifier: Apache-2.0
#include "format/steady_json.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>

#include "kelpie/model/open_loop.hpp"
#include "kelpie/model/trained_model.hpp"
#include "kelpie/motion/term_set.hpp"
#include "model/snapshot.hpp"
#include "model/steady_part.hpp"
#include "motion/states.hpp"

namespace kelpie::format {

using file::Json;
using file::JsonNode;

namespace {

SteadyModel read_steady(const JsonNode& node, std::size_t state, std::size_t terms,
                        std::size_t inputs) {
  SteadyModel steady;
  steady.state = state;
  steady.weights = node["weights"].numbers(terms + 1);
  steady.error = node["error"].number();
  steady.error_time_s = node["error_time_s"].number();
  steady.noise = node["noise"].number();
  steady.share = node["share"].number();
  node["share"].require(steady.share >= 0.0 && steady.share <= 1.0, "has to be from 0 to 1");
  std::ranges::copy(node["off"].numbers(steady.off.size()), steady.off.begin());
  std::ranges::copy(node["kept"].numbers(steady.kept.size()), steady.kept.begin());
  for (const JsonNode& range : node["seen"].items()) {
    const std::vector<double> ends = range.numbers(2);
    range.require(ends[0] <= ends[1], "has to go up");
    steady.seen.push_back({ends[0], ends[1]});
  }
  node["seen"].require(steady.seen.size() == inputs, "needs one range per input");
  return steady;
}

// Of a version without practice, or one that took angles for commands: to be learned again.
bool is_older(const Json& steady, std::size_t terms, std::size_t angles_as_commands) {
  return !steady.contains("share") || (terms != angles_as_commands && steady.contains("weights") &&
                                       steady["weights"].size() == angles_as_commands + 1);
}

}  // namespace

Json steady_json(const SteadyModel& steady) {
  if (!steady.ready()) {
    return nullptr;
  }
  return {{"weights", steady.weights},
          {"error", steady.error},
          {"error_time_s", steady.error_time_s},
          {"noise", steady.noise},
          {"share", steady.share},
          {"off", steady.off},
          {"kept", steady.kept},
          {"seen", file::list(steady.seen, [](const Extremes& range) {
             return Json{range.low, range.high};
           })}};
}

void read_steady_parts(const std::vector<JsonNode>& axes, TrainedModel& model) {
  const std::vector<std::size_t> states =
      find_states(model.settings.shared.states, model.input_names, axes.size());
  const Attitude attitude = attitude_for(model.settings.shared.terms, model.input_names);
  const std::size_t terms = TermSet::open_loop(model.input_names, states, attitude).size();
  const std::size_t angles_as_commands = TermSet::open_loop(model.input_names, states).size();
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (!axes[i].json().contains("steady")) {
      continue;  // a version without rollouts
    }
    const JsonNode node = axes[i]["steady"];
    if (!node.json().is_null() && !is_older(node.json(), terms, angles_as_commands)) {
      node.require(!states.empty() && terms > 0,
                   "is given, but the setting 'states' names no velocities");
      model.axes[i].steady = read_steady(node, states[i], terms, model.input_names.size());
    }
  }
}

}  // namespace kelpie::format
