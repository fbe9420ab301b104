// SPDX-License-Identifier: Apache-2.0
#include "lab/mission_path.hpp"

#include <cmath>
#include <numbers>

namespace kelpie::lab {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSpeed = 0.15;  // m/s
constexpr double kSetOffS = 5.0;
constexpr double kLegS = 60.0;
constexpr double kTurnS = 80.0;
constexpr double kEightS = 200.0;      // once round
constexpr double kEightSwing = 2.405;  // rad: the first zero of J₀

}  // namespace

std::string path_name(PathKind kind) {
  switch (kind) {
    case PathKind::lawn_mower:
      return "lawn-mower";
    case PathKind::figure_of_eight:
      return "figure of eight";
    case PathKind::station:
      return "station keeping";
  }
  return {};
}

const Reference& MissionPath::advance(double dt_s) {
  place(time_s_ + 0.5 * dt_s);
  reference_.pose +=
      dt_s * Pose2(reference_.speed * std::cos(reference_.pose.z()),
                   reference_.speed * std::sin(reference_.pose.z()), reference_.yaw_rate);
  time_s_ += dt_s;
  place(time_s_);
  return reference_;
}

// Speed and turn at a moment.
void MissionPath::place(double time_s) {
  if (kind_ == PathKind::station) {
    return;
  }
  const double left = std::exp(-time_s / kSetOffS);
  reference_.speed = kSpeed * (1.0 - left);
  reference_.speed_rate = kSpeed / kSetOffS * left;
  if (kind_ == PathKind::figure_of_eight) {
    const double omega = 2.0 * kPi / kEightS;
    reference_.yaw_rate = kEightSwing * omega * std::cos(omega * time_s);
    reference_.yaw_rate_rate = -kEightSwing * omega * omega * std::sin(omega * time_s);
    return;
  }
  const double leg = std::floor(time_s / (kLegS + kTurnS));
  const double turned_s = time_s - leg * (kLegS + kTurnS) - kLegS;
  const double side = std::fmod(leg, 2.0) == 0.0 ? 1.0 : -1.0;
  const double omega = 2.0 * kPi / kTurnS;
  const bool turning = turned_s > 0.0;
  reference_.yaw_rate = turning ? side * kPi / kTurnS * (1.0 - std::cos(omega * turned_s)) : 0.0;
  reference_.yaw_rate_rate =
      turning ? side * kPi / kTurnS * omega * std::sin(omega * turned_s) : 0.0;
}

}  // namespace kelpie::lab
