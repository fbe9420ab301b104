// SPDX-License-Identifier: Apache-2.0
#include "kelpie/physics/states.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <numeric>

#include "kelpie/core/error.hpp"
#include "kelpie/core/text.hpp"

namespace kelpie {
namespace {

constexpr std::array<std::string_view, 21> kVelocities{
    "u",    "v",         "w",          "p",        "q",        "r",         "surge",
    "sway", "heave",     "vx",         "vy",       "vz",       "v_x",       "v_y",
    "v_z",  "roll_rate", "pitch_rate", "yaw_rate", "rollrate", "pitchrate", "yawrate"};
constexpr std::array<std::string_view, 3> kLinear{"surge", "sway", "heave"};
constexpr std::array<std::string_view, 3> kEndings{"_velocity", "_speed", "_vel"};
constexpr std::array<std::string_view, 3> kAxes{"x", "y", "z"};

bool is_among(std::string_view text, const auto& list) {
  return std::ranges::find(list, text) != list.end();
}

// As messages of ROS have it: twist.linear.x, linear_velocity.x; not accel.linear.x.
bool is_velocity_field(const std::vector<std::string>& parts) {
  const std::size_t last = parts.size() - 1;
  const std::string& of = parts[last - 1];
  if (!is_among(parts[last], kAxes)) {
    return false;
  }
  const bool of_twist = last >= 2 && (parts[last - 2] == "twist" || parts[last - 2] == "velocity");
  return of == "linear_velocity" || of == "angular_velocity" ||
         (of_twist && (of == "linear" || of == "angular"));
}

bool is_velocity(std::string name) {
  std::ranges::transform(name, name.begin(), [](unsigned char letter) {
    return letter == '/' ? '.' : static_cast<char>(std::tolower(letter));
  });
  if (const std::vector<std::string> parts = split_text(name, '.'); parts.size() > 1) {
    return is_velocity_field(parts);
  }
  return is_among(name, kVelocities) || std::ranges::any_of(kEndings, [&](std::string_view ending) {
           return name.ends_with(ending) &&
                  is_among(std::string_view(name).substr(0, name.size() - ending.size()), kLinear);
         });
}

[[noreturn]] void reject_states(const std::string& what) {
  throw InputError("states", what);
}

}  // namespace

std::size_t named_velocities(std::span<const std::string> inputs) {
  return static_cast<std::size_t>(std::ranges::find_if_not(inputs, is_velocity) - inputs.begin());
}

std::vector<std::size_t> find_states(std::string_view specification,
                                     std::span<const std::string> inputs, std::size_t targets) {
  const std::string_view wanted = trimmed(specification);
  std::vector<std::size_t> states;
  if (wanted == "auto") {
    states.resize(named_velocities(inputs) == targets ? targets : 0);
    std::iota(states.begin(), states.end(), std::size_t{0});
    return states;
  }
  if (wanted == "none") {
    return states;
  }
  for (const std::string& name : split_text(wanted, ',')) {
    const auto found = std::ranges::find(inputs, name);
    if (found == inputs.end()) {
      reject_states("no input '" + name + "'" + did_you_mean(name, inputs));
    }
    states.push_back(static_cast<std::size_t>(found - inputs.begin()));
    if (std::ranges::count(states, states.back()) > 1) {
      reject_states("names '" + name + "' twice");
    }
  }
  if (states.size() != targets) {
    reject_states("names " + std::to_string(states.size()) + " inputs; there are " +
                  std::to_string(targets) + " targets, and each has its velocity");
  }
  return states;
}

}  // namespace kelpie
