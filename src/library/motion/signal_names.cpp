// SPDX-License-Identifier: Apache-2.0
#include "motion/signal_names.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>

namespace kelpie {
namespace {

// Names of consecutive axes.
struct VelocityNames {
  std::size_t first;  // axis of the first name
  std::array<std::string_view, 3> names;
};

constexpr std::array kVelocities = std::to_array<VelocityNames>({
    {0, {"u", "v", "w"}},
    {0, {"surge", "sway", "heave"}},
    {0, {"vx", "vy", "vz"}},
    {0, {"v_x", "v_y", "v_z"}},
    {3, {"p", "q", "r"}},
    {3, {"roll_rate", "pitch_rate", "yaw_rate"}},
    {3, {"rollrate", "pitchrate", "yawrate"}},
});

// Beginnings of a thruster's name, numbered or not; and letters that need a number.
constexpr std::array kThrusterWords = std::to_array<std::string_view>(
    {"thruster",  "thrust",   "thr",      "motor",      "rotor",       "prop",
     "rpm",       "rps",      "esc",      "servo",      "cmd",         "command",
     "control",   "actuator", "throttle", "surge_left", "surge_right", "port",
     "starboard", "left",     "right",    "bow",        "stern"});
constexpr std::array kThrusterLetters = std::to_array<std::string_view>({"th", "t", "n", "m"});

}  // namespace

std::optional<std::size_t> certain_velocity_axis(std::string_view name) {
  for (const VelocityNames& row : kVelocities) {
    const auto* const found = std::ranges::find(row.names, name);
    if (found != row.names.end()) {
      return row.first + static_cast<std::size_t>(found - row.names.begin());
    }
  }
  return std::nullopt;
}

bool names_thruster(std::string_view column) {
  std::string name(column.substr(column.find_last_of("./") + 1));
  std::ranges::transform(name, name.begin(), [](unsigned char letter) {
    return static_cast<char>(std::tolower(letter));
  });
  const auto is_word = [&](std::string_view word) { return name.starts_with(word); };
  const auto is_numbered = [&](std::string_view letters) {
    const std::string_view rest =
        is_word(letters) ? std::string_view(name).substr(letters.size()) : "";
    const std::size_t digits = rest.find_first_not_of('_');
    return digits != std::string_view::npos &&
           std::ranges::all_of(rest.substr(digits),
                               [](unsigned char c) { return std::isdigit(c) != 0; });
  };
  return std::ranges::any_of(kThrusterWords, is_word) ||
         std::ranges::any_of(kThrusterLetters, is_numbered) ||
         column.find("thrust") != std::string_view::npos;
}

}  // namespace kelpie
