// SPDX-License-Identifier: Apache-2.0
#include "study/alignment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <span>
#include <utility>
#include <vector>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "study/current.hpp"

namespace kelpie::study {
namespace {

AlignmentResult given_alignment(const AlignmentProblem& problem, const std::string& wish) {
  double seconds = 0.0;
  parse_number(wish, seconds);  // "none" is 0 s
  AlignmentResult found{.alignment = Alignment::by(seconds, problem.input_names,
                                                   find_commands(problem), problem.rate_hz)
                                         .with(problem.known),
                        .gain = 0.0,
                        .why = "as given by --align"};
  if (found.alignment.commands.empty()) {
    throw InputError("--align",
                     "no inputs are known to be velocities and others commands; name the "
                     "velocities with --set states=u,v,r");
  }
  if (!found.alignment.shifts() && seconds != 0.0) {
    found.why = fmt::format("{} s are less than half a row", wish);
  }
  return found;
}

}  // namespace

AlignmentProblem alignment_problem(const log::Dataset& data, const Split& split,
                                   const std::string& states) {
  return {.inputs = data.inputs,
          .targets = data.targets,
          .times_s = data.times_s,
          .configurations = data.configurations,
          .rows = split.training,
          .input_names = data.input_names,
          .target_count = data.target_names.size(),
          .states = states,
          .rate_hz = data.rate_hz,
          .known = known_actuators(data.actuators)};
}

std::map<std::string, Actuator> known_actuators(
    const std::map<std::string, log::KnownActuator>& known) {
  std::map<std::string, Actuator> actuators;
  for (const auto& [command, one] : known) {
    actuators[command] = {.neutral = one.neutral, .dead_band = one.dead_band, .astern = one.astern};
  }
  return actuators;
}

void check_align(const std::string& wish, const std::string& field) {
  double seconds = 0.0;
  require(wish == "auto" || wish == "none" ||
              (parse_number(wish, seconds) && std::abs(seconds) <= Alignment::kMostS),
          field,
          fmt::format("'{0}' is not known; it takes auto, none or seconds from -{1} to {1}", wish,
                      Alignment::kMostS));
}

AlignmentResult choose_alignment(const log::Dataset& data, const Split& split,
                                 const std::string& states, const std::string& wish) {
  if (wish == "none" && data.actuators.empty()) {
    return {.alignment = {}, .gain = 0.0, .why = "as given by --align"};
  }
  check_align(wish, "--align");
  const AlignmentProblem problem = alignment_problem(data, split, states);
  return wish == "auto" ? find_alignment(problem) : given_alignment(problem, wish);
}

std::vector<std::string> commands_of(const log::Dataset& data, const Split& split,
                                     const std::string& states) {
  std::vector<std::string> names;
  for (const std::size_t i : find_commands(alignment_problem(data, split, states))) {
    names.push_back(data.input_names[i]);
  }
  return names;
}

AlignmentResult alignment_at(const Alignment& alignment, double rate_hz, const std::string& file) {
  return {.alignment = alignment.at(rate_hz), .gain = 0.0, .why = "as in " + file};
}

std::vector<LagInterval> lags_of(const log::Dataset& data, const Split& split,
                                 const Alignment& alignment) {
  return lag_intervals(alignment_problem(data, split, "auto"), alignment);
}

log::Dataset aligned(log::Dataset data, const Alignment& alignment) {
  data = through_water(std::move(data), alignment.water);
  if (!alignment.shifts() && alignment.actuators.empty()) {
    return data;
  }
  std::vector<std::size_t> commands;
  for (const std::string& name : alignment.commands) {
    commands.push_back(data.require_input(name, "is to be shifted"));
  }
  const int most = static_cast<int>(data.rows());
  const std::size_t width = data.input_names.size();
  const auto align = [&](std::vector<double>& given) {
    AlignedRows rows(std::clamp(alignment.rows_at(data.rate_hz), -most, most), commands, width, 0,
                     data.rate_hz, alignment.actuators);
    std::vector<double> inputs;
    inputs.reserve(given.size());
    const auto take = [&](std::span<const double> x, std::span<const double>, double) {
      inputs.insert(inputs.end(), x.begin(), x.end());
    };
    for (std::size_t row = 0; row < given.size() / width; ++row) {
      if (row > 0 && !data.configurations.empty() &&
          data.configurations[row] != data.configurations[row - 1]) {
        rows.finish(take);
      }
      rows.push(std::span(given).subspan(row * width, width), {}, data.times_s[row], take);
    }
    rows.finish(take);
    given = std::move(inputs);
  };
  align(data.inputs);
  if (!data.pose_inputs.empty()) {
    align(data.pose_inputs);
  }
  return data;
}

std::string alignment_text(const AlignmentResult& found, double rate_hz) {
  Alignment commands = found.alignment;
  commands.water = {};
  return commands.text(rate_hz) + ": " + found.why;
}

}  // namespace kelpie::study
