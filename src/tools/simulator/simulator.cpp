// SPDX-License-Identifier: Apache-2.0
#include "simulator/simulator.hpp"

#include <cmath>
#include <sstream>

#include "kelpie/core/error.hpp"

namespace kelpie::simulator {
namespace {

[[noreturn]] void fail(const State& state, double time_s) {
  const Eigen::IOFormat list(6, Eigen::DontAlignCols, ", ", ", ", "", "", "(", ")");
  std::ostringstream text;
  text << "the simulation left finite numbers at t = " << time_s << " s; the last state: position "
       << state.position_m.format(list) << " m, velocity " << state.velocity.format(list)
       << " m/s and rad/s, rotors " << state.rotors_rps.format(list)
       << " (rev/s or share). Damping or thrust is too strong for steps of " << kTickS << " s.";
  throw InputError(text.str());
}

}  // namespace

std::int64_t ticks_in(double duration_s) {
  const double ticks = duration_s * kTicksPerSecond;
  const double whole = std::round(ticks);
  const bool fits = whole >= 1.0 && whole < 1e15 && std::abs(ticks - whole) <= 1e-9 * whole;
  return fits ? static_cast<std::int64_t>(whole) : 0;
}

Simulator::Simulator(const VehicleParameters& vehicle, const Plant& plant,
                     const Eigen::Vector3d& current_m_s,
                     const State& start)  // NOLINT(modernize-pass-by-value): all numbers
    : vehicle_(vehicle),
      current_(current_m_s),
      dynamics_(plant, current_m_s),
      battery_(vehicle.battery),
      state_(start) {
  const RotorSpeeds stopped =
      RotorSpeeds::Zero(static_cast<Eigen::Index>(vehicle.thrusters.size()));
  if (drives_in_plane(vehicle)) {
    hold_.emplace(vehicle);
  }
  if (state_.rotors_rps.size() == 0) {
    state_.rotors_rps = stopped;
  }
  drive_ = {.commands_rps = stopped, .lag_s = vehicle.rotor_lag_s, .rate = vehicle.rotor_rate};
  commands_ = stopped;
  waiting_.assign(static_cast<std::size_t>(ticks_in(vehicle.rotor_delay_s)), stopped);
  dynamics_.set_thrust_factor(battery_.thrust_factor());
}

void Simulator::set_plant(const Plant& plant) {
  dynamics_ = Dynamics(plant, current_);
  dynamics_.set_thrust_factor(battery_.thrust_factor());
}

RotorSpeeds Simulator::delayed(const RotorSpeeds& commands) {
  if (waiting_.empty()) {
    return commands;
  }
  RotorSpeeds& slot = waiting_[static_cast<std::size_t>(ticks_) % waiting_.size()];
  RotorSpeeds due = slot;
  slot = commands;
  return due;
}

void Simulator::advance(const RotorSpeeds& commands) {
  commands_ = commands;
  drive_.commands_rps = delayed(commands);
  for (Eigen::Index i = 0; i < commands.size(); ++i) {
    drive_.commands_rps(i) =
        speed_for_command(vehicle_.thrusters[static_cast<std::size_t>(i)], drive_.commands_rps(i));
  }
  battery_.draw(thruster_power_w(vehicle_, state_.rotors_rps, dynamics_.thrust_factor()), kTickS);
  dynamics_.set_thrust_factor(battery_.thrust_factor());
  const State next = rk4_step(dynamics_, state_, drive_, kTickS);
  ++ticks_;
  if (!next.is_finite()) {
    fail(state_, time_s());
  }
  state_ = next;
}

void Simulator::advance_in_plane(const Eigen::Vector3d& lateral_rps) {
  RotorSpeeds commands(static_cast<Eigen::Index>(kPlanarThrusterCount));
  commands << lateral_rps, hold_->update(state_, kTickS);
  advance(commands);
}

Vector6 Simulator::acceleration() const {
  return dynamics_.acceleration(state_.attitude, state_.velocity, state_.rotors_rps);
}

}  // namespace kelpie::simulator
