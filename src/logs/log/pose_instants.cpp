// SPDX-License-Identifier: Apache-2.0
#include "log/pose_instants.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/angle.hpp"
#include "log/streamed_signals.hpp"
#include "stream/attitude_source.hpp"

namespace kelpie::log {
namespace {

constexpr double kSameTimeS = 1e-6;  // of two rows: rounding of stamps

// The heading of a quaternion takes the place of w; parts in other messages give none.
bool take_heading(const StreamPlan& plan, std::vector<Signal>& signals) {
  std::array<std::size_t, 4> places{};
  std::ranges::transform(plan.pose->attitude, places.begin(),
                         [&](const std::string& name) { return plan.source(name); });
  Signal& heading = signals[places[0]];
  for (const std::size_t place : places) {
    if (signals[place].times_s != heading.times_s) {
      return false;
    }
  }
  for (std::size_t k = 0; k < heading.values.size(); ++k) {
    heading.values[k] =
        roll_pitch_yaw({heading.values[k], signals[places[1]].values[k],
                        signals[places[2]].values[k], signals[places[3]].values[k]})[2];
  }
  return true;
}

// Turns of the heading go on past ±π, so that a line between two samples goes the short way.
void make_continuous(double turn, Signal& heading) {
  double last = std::numeric_limits<double>::quiet_NaN();
  for (double& value : heading.values) {
    value = std::isfinite(last) ? last + std::remainder(value - last, turn) : value;
    last = std::isfinite(value) ? value : last;
  }
}

}  // namespace

Table pose_instants(const StreamPlan& plan, std::vector<Signal> signals) {
  if (!plan.pose || plan.pose->position[0].empty() || plan.pose->attitude.size() < 3) {
    return {};
  }
  const bool is_quaternion = plan.pose->attitude.size() == 4;
  const std::string heading = plan.pose->attitude[is_quaternion ? 0 : 2];
  if (heading.empty() || (is_quaternion && !take_heading(plan, signals))) {
    return {};
  }
  StreamPlan at_once = plan;
  at_once.pose.reset();
  at_once.derived.clear();
  const std::size_t of_heading = plan.source(heading);
  make_continuous(kFullTurn / std::abs(plan.sources[of_heading].scale), signals[of_heading]);
  at_once.inputs = {plan.pose->position[0], plan.pose->position[1], heading};
  const std::vector<std::string> of_pose = plan.pose->sources();
  for (std::size_t k = 0; k < signals.size(); ++k) {
    StreamPlan::Source& source = at_once.sources[k];
    if (std::ranges::find(of_pose, source.name) == of_pose.end()) {
      at_once.inputs.push_back(source.name);
      source.between =
          median_step_s(signals[k]) * plan.rate_hz < 1.5 ? Interpolation::line : source.between;
    }
  }
  StreamedSignals streamed(at_once, signals);
  Table table;
  table.lines.resize(streamed.times_s.size());
  std::iota(table.lines.begin(), table.lines.end(), std::size_t{1});
  table.names.assign(kInstantColumns.begin(), kInstantColumns.end());
  table.names.insert(table.names.end(), at_once.inputs.begin() + 3, at_once.inputs.end());
  table.columns = std::move(streamed.columns);
  table.columns.insert(table.columns.begin(), streamed.times_s);
  return table;
}

void add_pose_instants(const Table& instants, Dataset& data) {
  if (instants.rows() == 0) {
    return;
  }
  const std::vector<double>& times_s = instants.columns[0];
  data.pose_inputs = data.inputs;
  std::size_t at = 0;
  for (std::size_t row = 0; row < data.rows(); ++row) {
    while (at + 1 < times_s.size() && times_s[at] < data.times_s[row] - kSameTimeS) {
      ++at;
    }
    const bool is_there = std::abs(times_s[at] - data.times_s[row]) <= kSameTimeS;
    const auto value = [&](std::size_t column) {
      return is_there ? instants.columns[column][at] : std::numeric_limits<double>::quiet_NaN();
    };
    data.poses.insert(data.poses.end(), {value(1), value(2), value(3)});
    for (std::size_t column = kInstantColumns.size(); column < instants.names.size(); ++column) {
      const auto input = data.find_input(instants.names[column]);
      if (input && std::isfinite(value(column))) {
        data.pose_inputs[row * data.input_names.size() + *input] = value(column);
      }
    }
  }
}

}  // namespace kelpie::log
