// SPDX-License-Identifier: Apache-2.0
#include "lab/closed_loop.hpp"

#include <cmath>
#include <numbers>

#include "lab/controllers.hpp"
#include "simulator/excitation.hpp"
#include "simulator/frames.hpp"
#include "simulator/sensors.hpp"
#include "simulator/simulator.hpp"

namespace kelpie::lab {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSpeed = 0.15;  // m/s
constexpr double kSetOffS = 5.0;
constexpr double kLegS = 60.0;
constexpr double kTurnS = 80.0;
constexpr double kEightS = 200.0;      // once round
constexpr double kEightSwing = 2.405;  // rad: the first zero of J₀

constexpr double kCurrent = 0.08;         // m/s
constexpr double kPositionNoise = 0.005;  // m
constexpr double kHeadingNoise = 0.002;   // rad
constexpr std::int64_t kControlTicks = 10;

simulator::Configuration configuration_of(Mishap mishap) {
  simulator::Configuration configuration;
  if (mishap == Mishap::thruster || mishap == Mishap::outage_thruster) {
    configuration.effectiveness(simulator::kSurgeRight) = 0.5;
  } else if (mishap == Mishap::weak_thruster) {
    configuration.effectiveness(simulator::kSurgeRight) = 0.2;
  } else if (mishap == Mishap::payload) {
    configuration.damping_factor.setConstant(1.3);
    configuration.payload.mass_kg = 20.0;
    configuration.payload.buoyancy_n = 20.0 * simulator::kGravity;
    configuration.payload.position_m = {0.2, 0.0, 0.0};
  }
  return configuration;
}

Eigen::Vector3d current_towards(double direction) {
  return {kCurrent * std::cos(direction), kCurrent * std::sin(direction), 0.0};
}

// The simulator seen in the plane, FLU.
class Swimming {
 public:
  Swimming(const simulator::VehicleParameters& vehicle, std::uint64_t seed)
      : vehicle_(vehicle),
        simulator_(vehicle, simulator::make_plant(vehicle, {}), current_, simulator::State{}),
        sensors_(simulator::noise_preset("as_recorded"), seed),
        noise_(seed, "position") {}

  void become(Mishap mishap) {
    simulator_.set_plant(simulator::make_plant(vehicle_, configuration_of(mishap)));
  }

  void set_current(const Eigen::Vector3d& current, Mishap mishap) {
    current_ = current;
    simulator_ =
        simulator::Simulator(vehicle_, simulator::make_plant(vehicle_, configuration_of(mishap)),
                             current_, simulator_.state());
  }

  Pose2 pose() const {
    const simulator::State& state = simulator_.state();
    const Eigen::Matrix3d to_world = state.attitude.toRotationMatrix();
    return {state.position_m.x(), -state.position_m.y(),
            -std::atan2(to_world(1, 0), to_world(0, 0))};
  }

  Sensed sense(bool silent = false) {
    const simulator::State& state = simulator_.state();
    const double x = kPositionNoise * noise_.normal();
    const double y = kPositionNoise * noise_.normal();
    return {.time_s = static_cast<double>(periods_) * kControlPeriodS,
            .pose = pose() + Pose2(x, y, kHeadingNoise * noise_.normal()),
            .velocity = sensors_.measure(simulator::planar_flu(state.velocity)),
            .rotors_rps = state.rotors_rps.head<3>(),
            .silent = silent};
  }

  void drive(const Eigen::Vector3d& commands) {
    for (std::int64_t tick = 0; tick < kControlTicks; ++tick) {
      simulator_.advance_in_plane(commands);
    }
    ++periods_;
  }

 private:
  const simulator::VehicleParameters& vehicle_;
  Eigen::Vector3d current_ = Eigen::Vector3d::Zero();
  simulator::Simulator simulator_;
  simulator::VelocitySensors sensors_;
  RandomStream noise_;
  std::int64_t periods_ = 0;
};

// Root mean square of distances.
class MeanSquare {
 public:
  void add(double distance) {
    sum_ += distance * distance;
    ++count_;
  }
  double root() const { return count_ > 0 ? std::sqrt(sum_ / static_cast<double>(count_)) : 0.0; }

 private:
  double sum_ = 0.0;
  std::size_t count_ = 0;
};

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

std::string mishap_name(Mishap mishap) {
  switch (mishap) {
    case Mishap::none:
      return "nominal";
    case Mishap::thruster:
      return "damaged thruster";
    case Mishap::payload:
      return "payload";
    case Mishap::current:
      return "current";
    case Mishap::weak_thruster:
      return "weak thruster";
    case Mishap::outage:
      return "outage";
    case Mishap::outage_thruster:
      return "outage after damage";
    case Mishap::outage_current:
      return "outage in a current";
  }
  return {};
}

bool has_outage(Mishap mishap) {
  return mishap == Mishap::outage || mishap == Mishap::outage_thruster ||
         mishap == Mishap::outage_current;
}

MissionErrors fly(const simulator::VehicleParameters& vehicle, const Mission& mission,
                  Controller& controller) {
  Swimming swimming(vehicle, mission.seed);
  MissionPath path(mission.path);
  const double from = RandomStream(mission.seed, "current").uniform(0.0, 2.0 * std::numbers::pi);
  const bool station = mission.path == PathKind::station;
  if (station) {
    swimming.set_current(current_towards(from), Mishap::none);
  }
  const MissionTimes& times = mission.times;
  const double happens_s = times.settle_s + times.before_s;
  const bool outage = has_outage(mission.mishap);
  const double changes_s = outage ? times.settle_s : happens_s;
  bool happened = false;
  MeanSquare before;
  MeanSquare during;
  MeanSquare after;
  MissionErrors result;
  const auto periods = static_cast<std::int64_t>(std::llround(times.all_s() / kControlPeriodS));
  for (std::int64_t k = 0; k < periods; ++k) {
    const double t = static_cast<double>(k) * kControlPeriodS;
    if (!happened && t >= changes_s) {
      happened = true;
      swimming.become(mission.mishap);
      if (mission.mishap == Mishap::current || mission.mishap == Mishap::outage_current) {
        swimming.set_current(current_towards(from + (station ? 0.5 * std::numbers::pi : 0.0)),
                             mission.mishap);
      }
    }
    const Sensed sensed =
        swimming.sense(outage && t >= happens_s && t < happens_s + times.during_s);
    const double error = (path.reference().pose - swimming.pose()).head<2>().norm();
    if (t >= times.settle_s) {
      (t < happens_s ? before : t < happens_s + times.during_s ? during : after).add(error);
    }
    if (k % 10 == 0) {
      result.time_s.push_back(t);
      result.error_m.push_back(error);
      result.track.emplace_back(swimming.pose().head<2>());
    }
    swimming.drive(controller.update(path.reference(), sensed));
    path.advance(kControlPeriodS);
  }
  result.before = before.root();
  result.during = during.root();
  result.after = after.root();
  result.fallback_share = controller.fallback_share();
  return result;
}

DynamicsModel commissioned(const simulator::VehicleParameters& vehicle, double seconds,
                           std::uint64_t seed) {
  Swimming swimming(vehicle, seed);
  const NominalModel nominal(vehicle);
  simulator::Excitation excitation({}, nominal.most_rps, seed);
  SlopeWindow window;
  DynamicsModel model = untaught_model();
  std::size_t measured = 0;
  const auto periods = static_cast<std::int64_t>(std::llround(seconds / kControlPeriodS));
  for (std::int64_t k = 0; k < periods; ++k) {
    if (const auto sample = window.add(swimming.sense()); sample && ++measured % 2 == 0) {
      const auto& [middle, a] = *sample;
      model.update(std::array{middle.velocity(0), middle.velocity(1), middle.velocity(2),
                              middle.rotors_rps(0), middle.rotors_rps(1), middle.rotors_rps(2)},
                   std::array{a(0), a(1), a(2)}, middle.time_s);
    }
    swimming.drive(excitation.advance(kControlPeriodS, 1.0));
  }
  model.learn_held_back();
  return model;
}

}  // namespace kelpie::lab
