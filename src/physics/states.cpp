// SPDX-License-Identifier: Apache-2.0
#include "kelpie/physics/states.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "kelpie/core/error.hpp"
#include "kelpie/core/text.hpp"

namespace kelpie {
namespace {

constexpr std::array<std::string_view, 6> kVelocities{"u", "v", "w", "p", "q", "r"};

[[noreturn]] void reject_states(const std::string& what) {
  throw InputError("states", what);
}

}  // namespace

std::size_t named_velocities(std::span<const std::string> inputs) {
  const auto is_velocity = [](const std::string& name) {
    return std::ranges::find(kVelocities, name) != kVelocities.end();
  };
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
