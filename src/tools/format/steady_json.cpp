// SPDX-License-Identifier: Apache-2.0
#include "format/steady_json.hpp"

#include <cstddef>
#include <span>
#include <string>

#include "kelpie/model/open_loop.hpp"
#include "kelpie/model/trained_model.hpp"
#include "kelpie/motion/states.hpp"
#include "kelpie/motion/term_set.hpp"
#include "model/snapshot.hpp"
#include "model/steady_part.hpp"

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
  steady.learned_error = node["learned_error"].number();
  steady.noise = node["noise"].number();
  for (const JsonNode& range : node["seen"].items()) {
    const std::vector<double> ends = range.numbers(2);
    range.require(ends[0] <= ends[1], "has to go up");
    steady.seen.push_back({ends[0], ends[1]});
  }
  node["seen"].require(steady.seen.size() == inputs, "needs one range per input");
  return steady;
}

// How many terms all steady parts have; those of older versions had fewer.
std::size_t steady_term_count(const JsonNode& first, std::span<const std::string> inputs,
                              std::span<const std::size_t> states) {
  const std::size_t older = TermSet::manoeuvring(inputs, states).size();
  const bool old = !first.json().is_null() && first["weights"].items().size() == older + 1;
  return old ? older : TermSet::open_loop(inputs, states).size();
}

}  // namespace

Json steady_json(const SteadyModel& steady) {
  if (!steady.ready()) {
    return nullptr;
  }
  return {{"weights", steady.weights},
          {"error", steady.error},
          {"error_time_s", steady.error_time_s},
          {"learned_error", steady.learned_error},
          {"noise", steady.noise},
          {"seen", file::list(steady.seen, [](const Extremes& range) {
             return Json{range.low, range.high};
           })}};
}

void read_steady_parts(const std::vector<JsonNode>& axes, TrainedModel& model) {
  const std::vector<std::size_t> states =
      find_states(model.settings.shared.states, model.input_names, axes.size());
  const std::size_t terms = steady_term_count(axes.front()["steady"], model.input_names, states);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const JsonNode node = axes[i]["steady"];
    if (!node.json().is_null()) {
      node.require(!states.empty() && terms > 0,
                   "is given, but the setting 'states' names no velocities");
      model.axes[i].steady = read_steady(node, states[i], terms, model.input_names.size());
    }
  }
}

}  // namespace kelpie::format
