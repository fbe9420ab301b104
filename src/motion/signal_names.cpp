// SPDX-License-Identifier: Apache-2.0
#include "motion/signal_names.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace kelpie {
namespace {

// Names of consecutive axes.
struct VelocityNames {
  std::size_t first;  // axis of the first name
  std::array<std::string_view, 3> names;
};

// Names with one meaning.
constexpr std::array kVelocities = std::to_array<VelocityNames>({
    {0, {"u", "v", "w"}},
    {0, {"surge", "sway", "heave"}},
    {0, {"vx", "vy", "vz"}},
    {0, {"v_x", "v_y", "v_z"}},
    {3, {"p", "q", "r"}},
    {3, {"roll_rate", "pitch_rate", "yaw_rate"}},
    {3, {"rollrate", "pitchrate", "yawrate"}},
});

// Names that may have another meaning: for drafts, which a person checks.
constexpr std::array kLikelyVelocities = std::to_array<VelocityNames>({
    {0, {"vel_x", "vel_y", "vel_z"}},
    {0, {"velx", "vely", "velz"}},
    {0, {"velocity_x", "velocity_y", "velocity_z"}},
    {0, {"x_velocity", "y_velocity", "z_velocity"}},
    {0, {"x_vel", "y_vel", "z_vel"}},
    {0, {"vx_body", "vy_body", "vz_body"}},
    {0, {"body_vx", "body_vy", "body_vz"}},
    {0, {"linear_x", "linear_y", "linear_z"}},
    {3, {"angular_x", "angular_y", "angular_z"}},
    {3, {"wx", "wy", "wz"}},
    {3, {"w_x", "w_y", "w_z"}},
    {3, {"omega_x", "omega_y", "omega_z"}},
    {3, {"gyro_x", "gyro_y", "gyro_z"}},
    {3, {"rollspeed", "pitchspeed", "yawspeed"}},
    {3, {"roll_speed", "pitch_speed", "yaw_speed"}},
    {0, {"forward_speed"}},
    {0, {"forward_velocity"}},
    {5, {"heading_rate"}},
    {0, {"linear_velocity"}},
    {5, {"angular_velocity"}},
    {0, {"y_speed"}},
    {5, {"rate_of_turn"}},
    {5, {"rot"}},
    {0, {"nav_speed"}},
});

constexpr const char* kLetters =
    "the controller's output, by the letters of control theory: r, e, u, y";

using Kind = CommandName::Kind;
using Thruster = CommandName::Thruster;

// Names for drafts first; rank 0: for identification alone.
constexpr std::array kCommands = std::to_array<CommandName>({
    {"thruster#", Kind::thrust, 1, Thruster::prefix},
    {"thrusters", Kind::thrust, 1},
    {"thrust#", Kind::thrust, 1, Thruster::prefix},
    {"thr#", Kind::thrust, 1, Thruster::prefix},
    {"motor#", Kind::thrust, 1, Thruster::prefix},
    {"motors", Kind::thrust, 1},
    {"rpm#", Kind::thrust, 1, Thruster::prefix},
    {"rps#", Kind::thrust, 1, Thruster::prefix},
    {"pwm#", Kind::thrust, 1},
    {"servo#", Kind::thrust, 1, Thruster::prefix},
    {"prop#", Kind::thrust, 1, Thruster::prefix},
    {"propeller#", Kind::thrust, 1},
    {"throttle#", Kind::thrust, 1, Thruster::prefix},
    {"esc#", Kind::thrust, 1, Thruster::prefix},
    {"actuator#", Kind::thrust, 1, Thruster::prefix},
    {"actuators", Kind::thrust, 1},
    {"th#", Kind::thrust, 1, Thruster::numbered},
    {"n#", Kind::thrust, 1, Thruster::numbered},
    {"m#", Kind::thrust, 1, Thruster::numbered},
    {"cmd#", Kind::thrust, 1, Thruster::prefix},
    {"command#", Kind::thrust, 1, Thruster::prefix},
    {"commands", Kind::thrust, 1},
    {"control#", Kind::thrust, 1, Thruster::prefix},
    {"tau#", Kind::wrench, 2},
    {"taux", Kind::wrench, 2},
    {"tauy", Kind::wrench, 2},
    {"taun", Kind::wrench, 2},
    {"rudder#", Kind::angle, 1},
    {"fin#", Kind::angle, 1},
    {"fins", Kind::angle, 1},
    {"elevator#", Kind::angle, 1},
    {"delta#", Kind::angle, 1},
    {"azimuth#", Kind::angle, 1},
    {"az#", Kind::angle, 1},
    {"u_speed", Kind::thrust, 1, Thruster::no, kLetters},
    {"u_heading", Kind::angle, 1, Thruster::no, kLetters},
    {"rotor", Kind::thrust, 0, Thruster::prefix},
    {"surge_left", Kind::thrust, 0, Thruster::prefix},
    {"surge_right", Kind::thrust, 0, Thruster::prefix},
    {"port", Kind::thrust, 0, Thruster::prefix},
    {"starboard", Kind::thrust, 0, Thruster::prefix},
    {"left", Kind::thrust, 0, Thruster::prefix},
    {"right", Kind::thrust, 0, Thruster::prefix},
    {"bow", Kind::thrust, 0, Thruster::prefix},
    {"stern", Kind::thrust, 0, Thruster::prefix},
    {"t#", Kind::thrust, 0, Thruster::numbered},
});

std::optional<std::size_t> axis_in(std::span<const VelocityNames> table, std::string_view name) {
  for (const VelocityNames& row : table) {
    const auto* const found = std::ranges::find(row.names, name);
    if (!name.empty() && found != row.names.end()) {
      return row.first + static_cast<std::size_t>(found - row.names.begin());
    }
  }
  return std::nullopt;
}

bool is_digit(unsigned char letter) {
  return std::isdigit(letter) != 0;
}

// "thruster_2" for the prefix "thruster"; "th2" and "th_2" for the numbered "th".
bool fits(const CommandName& known, std::string_view name) {
  const std::string_view word = known.word.substr(0, known.word.find('#'));
  if (known.thruster == Thruster::no || !name.starts_with(word)) {
    return false;
  }
  const std::string_view rest = name.substr(word.size());
  const std::size_t digits = rest.find_first_not_of('_');
  return known.thruster == Thruster::prefix ||
         (digits != std::string_view::npos && std::ranges::all_of(rest.substr(digits), is_digit));
}

}  // namespace

std::optional<std::size_t> certain_velocity_axis(std::string_view name) {
  return axis_in(kVelocities, name);
}

std::optional<std::size_t> likely_velocity_axis(std::string_view name) {
  return axis_in(kLikelyVelocities, name);
}

std::span<const CommandName> command_names() {
  const auto* const last = std::ranges::find(kCommands, 0, &CommandName::rank);
  return {kCommands.begin(), last};
}

bool names_thruster(std::string_view column) {
  std::string name(column.substr(column.find_last_of("./") + 1));
  std::ranges::transform(name, name.begin(), [](unsigned char letter) {
    return static_cast<char>(std::tolower(letter));
  });
  return column.find("thrust") != std::string_view::npos ||
         std::ranges::any_of(kCommands,
                             [&](const CommandName& known) { return fits(known, name); });
}

}  // namespace kelpie
