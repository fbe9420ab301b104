// SPDX-License-Identifier: Apache-2.0
#include "motion/states.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <numeric>

#include "core/text.hpp"
#include "kelpie/core/error.hpp"
#include "motion/signal_names.hpp"

namespace kelpie {
namespace {

constexpr std::array<std::string_view, 3> kLinear{"surge", "sway", "heave"};
constexpr std::array<std::string_view, 3> kEndings{"_velocity", "_speed", "_vel"};
constexpr std::array<std::string_view, 3> kAxes{"x", "y", "z"};

std::optional<std::size_t> place_among(std::string_view text, const auto& list) {
  const auto found = std::ranges::find(list, text);
  return found == list.end() ? std::nullopt
                             : std::optional(static_cast<std::size_t>(found - list.begin()));
}

// As messages of ROS have it: twist.linear.x, linear_velocity.x; not accel.linear.x.
std::optional<std::size_t> axis_of_field(const std::vector<std::string>& parts) {
  const std::size_t last = parts.size() - 1;
  const std::string& of = parts[last - 1];
  const std::optional<std::size_t> axis = place_among(parts[last], kAxes);
  const bool of_twist = last >= 2 && (parts[last - 2] == "twist" || parts[last - 2] == "velocity");
  if (of == "linear_velocity" || (of_twist && of == "linear")) {
    return axis;
  }
  const bool is_rate = of == "angular_velocity" || (of_twist && of == "angular");
  return is_rate && axis ? std::optional(*axis + kAxes.size()) : std::nullopt;
}

std::optional<std::size_t> axis_of_word(std::string_view name) {
  if (const std::optional<std::size_t> axis = certain_velocity_axis(name)) {
    return axis;
  }
  for (const std::string_view ending : kEndings) {
    if (name.ends_with(ending)) {
      return place_among(name.substr(0, name.size() - ending.size()), kLinear);
    }
  }
  return std::nullopt;
}

[[noreturn]] void reject_states(const std::string& what) {
  throw InputError("states", what);
}

}  // namespace

std::optional<std::size_t> velocity_axis(std::string_view name) {
  std::string plain(name);
  std::ranges::transform(plain, plain.begin(), [](unsigned char letter) {
    return letter == '/' ? '.' : static_cast<char>(std::tolower(letter));
  });
  const std::vector<std::string> parts = split_text(plain, '.');
  return parts.size() > 1 ? axis_of_field(parts) : axis_of_word(plain);
}

std::vector<std::string_view> differentiated(std::string_view name) {
  std::vector<std::string_view> velocities;
  for (const std::string_view ending : {"_dot", "dot"}) {
    if (name.ends_with(ending) && name.size() > ending.size()) {
      velocities.push_back(name.substr(0, name.size() - ending.size()));
    }
  }
  if (name.starts_with('d') && name.size() > 1) {
    velocities.push_back(name.substr(1));
  }
  return velocities;
}

std::size_t named_velocities(std::span<const std::string> inputs) {
  const auto is_none = [](const std::string& name) { return !velocity_axis(name); };
  return static_cast<std::size_t>(std::ranges::find_if(inputs, is_none) - inputs.begin());
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
    states.push_back(require_name("states", name, "input", inputs));
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
