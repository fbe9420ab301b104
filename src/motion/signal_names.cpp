// SPDX-License-Identifier: Apache-2.0
#include "motion/signal_names.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace kelpie {
namespace {

struct VelocityName {
  std::string_view name;
  std::size_t axis;
};

// Names with one meaning.
constexpr std::array kVelocities = std::to_array<VelocityName>({
    {"u", 0},  {"surge", 0},     {"vx", 0},       {"v_x", 0},   {"v", 1},          {"sway", 1},
    {"vy", 1}, {"v_y", 1},       {"w", 2},        {"heave", 2}, {"vz", 2},         {"v_z", 2},
    {"p", 3},  {"roll_rate", 3}, {"rollrate", 3}, {"q", 4},     {"pitch_rate", 4}, {"pitchrate", 4},
    {"r", 5},  {"yaw_rate", 5},  {"yawrate", 5},
});

// Names that may have another meaning: for drafts, which a person checks.
constexpr std::array kLikelyVelocities = std::to_array<VelocityName>({
    {"vel_x", 0},
    {"vel_y", 1},
    {"vel_z", 2},
    {"velx", 0},
    {"vely", 1},
    {"velz", 2},
    {"velocity_x", 0},
    {"velocity_y", 1},
    {"velocity_z", 2},
    {"x_velocity", 0},
    {"y_velocity", 1},
    {"z_velocity", 2},
    {"x_vel", 0},
    {"y_vel", 1},
    {"z_vel", 2},
    {"vx_body", 0},
    {"vy_body", 1},
    {"vz_body", 2},
    {"body_vx", 0},
    {"body_vy", 1},
    {"body_vz", 2},
    {"linear_x", 0},
    {"linear_y", 1},
    {"linear_z", 2},
    {"angular_x", 3},
    {"angular_y", 4},
    {"angular_z", 5},
    {"wx", 3},
    {"wy", 4},
    {"wz", 5},
    {"w_x", 3},
    {"w_y", 4},
    {"w_z", 5},
    {"omega_x", 3},
    {"omega_y", 4},
    {"omega_z", 5},
    {"gyro_x", 3},
    {"gyro_y", 4},
    {"gyro_z", 5},
    {"rollspeed", 3},
    {"pitchspeed", 4},
    {"yawspeed", 5},
    {"roll_speed", 3},
    {"pitch_speed", 4},
    {"yaw_speed", 5},
    {"forward_speed", 0},
    {"forward_velocity", 0},
    {"heading_rate", 5},
    {"linear_velocity", 0},
    {"angular_velocity", 5},
    {"y_speed", 0},
    {"rate_of_turn", 5},
    {"rot", 5},
    {"nav_speed", 0},
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

std::optional<std::size_t> axis_in(std::span<const VelocityName> names, std::string_view name) {
  const auto found = std::ranges::find(names, name, &VelocityName::name);
  return found == names.end() ? std::nullopt : std::optional(found->axis);
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
