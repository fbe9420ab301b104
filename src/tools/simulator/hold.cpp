// SPDX-License-Identifier: Apache-2.0
#include "simulator/hold.hpp"

#include <algorithm>
#include <cmath>

#include "simulator/parameters.hpp"

namespace kelpie::simulator {
namespace {

constexpr Eigen::Index kHeave = 2;
constexpr Eigen::Index kRoll = 3;
constexpr Eigen::Index kPitch = 4;

}  // namespace

Eigen::Matrix2d vertical_allocation(const VehicleParameters& vehicle) {
  const Vector6 front = thrust_axis(vehicle.thrusters[kVerticalFront]);
  const Vector6 rear = thrust_axis(vehicle.thrusters[kVerticalRear]);
  return (Eigen::Matrix2d() << front(kHeave), rear(kHeave), front(kPitch), rear(kPitch)).finished();
}

LevelHold::Demand LevelHold::update(const State& state, double period_s) {
  const Eigen::Matrix3d to_world = state.attitude.toRotationMatrix();
  const double depth = state.position_m.z();
  const double depth_rate = to_world.row(2).dot(state.velocity.head<3>());
  const double pitch = std::asin(std::clamp(-to_world(2, 0), -1.0, 1.0));
  const double roll = std::atan2(to_world(2, 1), to_world(2, 2));

  // Bounded by what the thrusters can give, or it would wind up while they can't.
  integral_n_ = std::clamp(integral_n_ - gains_.depth_i * depth * period_s, -greatest_force_n_,
                           greatest_force_n_);
  return {.down_n = integral_n_ - gains_.depth_p * depth - gains_.depth_d * depth_rate,
          .roll_nm = -gains_.roll_p * roll - gains_.roll_d * state.velocity(kRoll),
          .pitch_nm = -gains_.pitch_p * pitch - gains_.pitch_d * state.velocity(kPitch)};
}

DepthPitchHold::DepthPitchHold(const VehicleParameters& vehicle)
    : front_(vehicle.thrusters[kVerticalFront]),
      rear_(vehicle.thrusters[kVerticalRear]),
      thrusts_from_demand_(vertical_allocation(vehicle).inverse()),
      level_(vehicle.hold,
             thrust(front_, front_.max_speed_rps) + thrust(rear_, rear_.max_speed_rps)) {}

Eigen::Vector2d DepthPitchHold::update(const State& state, double period_s) {
  const LevelHold::Demand demand = level_.update(state, period_s);
  const Eigen::Vector2d thrusts =
      thrusts_from_demand_ * Eigen::Vector2d(demand.down_n, demand.pitch_nm);
  return {speed_for_thrust(front_, thrusts(0)), speed_for_thrust(rear_, thrusts(1))};
}

}  // namespace kelpie::simulator
