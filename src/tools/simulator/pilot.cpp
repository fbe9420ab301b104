// SPDX-License-Identifier: Apache-2.0
#include "simulator/pilot.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "simulator/decomposition.hpp"
#include "simulator/stability.hpp"
#include "simulator/tuning.hpp"

namespace kelpie::simulator {
namespace {

double greatest_force(const std::vector<Thruster>& thrusters) {
  double force = 0.0;
  for (const Thruster& thruster : thrusters) {
    force += thrust(thruster, thruster.max_speed_rps);
  }
  return force;
}

}  // namespace

RandomSteps::RandomSteps(const ExcitationSettings& settings, bool binary, RandomStream stream)
    : shortest_s_(settings.shortest_period_s),
      longest_s_(settings.longest_period_s),
      binary_(binary),
      stream_(stream),
      level_(draw_level()),
      left_s_(stream_.uniform(shortest_s_, longest_s_)) {}

double RandomSteps::draw_level() {
  const double level = stream_.uniform(-1.0, 1.0);
  return binary_ ? std::copysign(1.0, level) : level;
}

double RandomSteps::advance(double dt_s) {
  left_s_ -= dt_s;
  if (left_s_ <= 0.0) {
    level_ = draw_level();
    left_s_ += stream_.uniform(shortest_s_, longest_s_);
  }
  return level_;
}

Pilot::Pilot(const VehicleParameters& vehicle, const ExcitationSettings& settings,
             std::uint64_t seed)
    : thrusters_(vehicle.thrusters),
      unit_(vehicle.command_unit),
      effort_(settings.effort),
      dither_(settings.dither),
      stick_lag_s_(settings.mode == ExcitationMode::pilot ? kTuning.stick_lag_s : 0.0),
      hold_(vehicle.hold, greatest_force(vehicle.thrusters)),
      thrusts_from_wrench_(pseudo_inverse(thrust_axes(vehicle.thrusters))) {
  const bool binary = settings.mode == ExcitationMode::prbs;
  for (std::size_t axis = 0; axis < 6; ++axis) {
    wishes_.emplace_back(settings, binary,
                         RandomStream(seed, std::string("pilot/") + axis_text(axis)));
  }
  for (const Thruster& thruster : thrusters_) {
    dithers_.emplace_back(settings, false, RandomStream(seed, "dither/" + thruster.name));
  }
}

RotorSpeeds Pilot::advance(const State& state, double dt_s, double amplitude) {
  for (std::size_t axis = 0; axis < wishes_.size(); ++axis) {
    double& stick = stick_(static_cast<Eigen::Index>(axis));
    const double wish = wishes_[axis].advance(dt_s);
    stick += stick_lag_s_ > 0.0 ? dt_s / stick_lag_s_ * (wish - stick) : wish - stick;
  }
  Vector6 wrench = amplitude * effort_.cwiseProduct(stick_);
  const LevelHold::Demand demand = hold_.update(state, dt_s);
  wrench.head<3>() += state.attitude.conjugate() * Eigen::Vector3d(0.0, 0.0, demand.down_n);
  wrench(3) += demand.roll_nm;
  wrench(4) += demand.pitch_nm;

  const RotorSpeeds thrusts = thrusts_from_wrench_ * wrench;
  RotorSpeeds commands(thrusts.size());
  for (Eigen::Index i = 0; i < thrusts.size(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const Thruster& thruster = thrusters_[at];
    const double most = thruster.max_speed_rps;
    const double wanted = command_for_speed(thruster, speed_for_thrust(thruster, thrusts(i))) +
                          amplitude * dither_ * most * dithers_[at].advance(dt_s);
    commands(i) = std::clamp(wanted, -most, most);
    if (unit_ == CommandUnit::pwm) {  // whole µs
      commands(i) =
          std::round(commands(i) * kTuning.pulse_per_share_us) / kTuning.pulse_per_share_us;
    }
  }
  return commands;
}

}  // namespace kelpie::simulator
