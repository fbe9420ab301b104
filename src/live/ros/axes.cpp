// SPDX-License-Identifier: Apache-2.0
#include "ros/axes.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <string_view>

#include "bag/topic_columns.hpp"
#include "motion/states.hpp"

namespace kelpie::ros {
namespace {

constexpr std::array<std::string_view, 6> kEndings{"_dot",   "dot",  "_acceleration",
                                                   "_accel", "_acc", "_velocity_dot"};

// "udot", "surge_acceleration", "yaw_rate_dot", "ax".
std::optional<std::size_t> axis_of_name(std::string name) {
  std::ranges::transform(name, name.begin(), [](unsigned char letter) {
    return static_cast<char>(std::tolower(letter));
  });
  for (const std::string_view ending : kEndings) {
    if (name.ends_with(ending)) {
      const std::string stem = name.substr(0, name.size() - ending.size());
      if (const auto axis = velocity_axis(stem)) {
        return axis;
      }
      const auto* const found = std::ranges::find(kAxisTexts, stem);
      if (found != kAxisTexts.end()) {
        return static_cast<std::size_t>(found - kAxisTexts.begin());
      }
    }
  }
  return std::nullopt;
}

// By the usual fields of ROS messages.
std::optional<std::size_t> axis_of_field(const std::string& from) {
  std::string pattern = bag::parse_column(from).pattern;
  for (const auto& [acceleration, velocity] :
       {std::pair("accel.", "twist."), std::pair("linear_acceleration.", "linear_velocity.")}) {
    const std::size_t at = pattern.rfind(acceleration);
    if (at != std::string::npos) {
      pattern.replace(at, std::string_view(acceleration).size(), velocity);
      return velocity_axis(pattern);
    }
  }
  return std::nullopt;
}

std::optional<std::size_t> axis_of(const live::Configuration& configuration, std::size_t target) {
  const StreamPlan& plan = configuration.plan;
  const std::string& name = plan.targets[target];
  const auto from_of = [&](const std::string& source) {
    const auto found = std::ranges::find(plan.sources, source, &StreamPlan::Source::name);
    return found == plan.sources.end() ? std::string() : found->from;
  };
  const auto derived = std::ranges::find(plan.derived, name, &StreamPlan::Derived::name);
  if (derived != plan.derived.end()) {
    if (const auto axis = velocity_axis(derived->of)) {
      return axis;
    }
    return velocity_axis(bag::parse_column(from_of(derived->of)).pattern);
  }
  const std::vector<std::size_t> states =
      find_states(configuration.settings.shared.states, plan.inputs, plan.targets.size());
  if (!states.empty()) {
    if (const auto axis = velocity_axis(plan.inputs[states[target]])) {
      return axis;
    }
  }
  if (const auto axis = axis_of_name(name)) {
    return axis;
  }
  const std::string from = from_of(name);
  return from.empty() ? std::nullopt : axis_of_field(from);
}

}  // namespace

std::vector<std::optional<std::size_t>> acceleration_axes(
    const live::Configuration& configuration) {
  std::vector<std::optional<std::size_t>> axes;
  for (std::size_t i = 0; i < configuration.plan.targets.size(); ++i) {
    const std::optional<std::size_t> axis = axis_of(configuration, i);
    const bool is_taken = axis && std::ranges::find(axes, axis) != axes.end();
    axes.push_back(is_taken ? std::nullopt : axis);
  }
  return axes;
}

}  // namespace kelpie::ros
