// SPDX-License-Identifier: Apache-2.0
#include "lab/diagnosis_study.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <utility>

#include "simulator/dynamics.hpp"

namespace kelpie::lab {
namespace {

constexpr std::array<Eigen::Index, 3> kBody{0, 1, 5};  // surge, sway, yaw
constexpr std::array kAxisNames{"surge", "sway", "yaw"};
constexpr std::array kSensorNames{"u", "v", "r"};
constexpr std::array kBiasUnits{0.25, 0.1, 0.2};
constexpr std::size_t kFirstThruster = 3;  // of the inputs u, v, r, th1, th2, th3

class Maker {
 public:
  explicit Maker(const simulator::VehicleParameters& vehicle) : vehicle_(vehicle) {
    plant_ = make_plant(vehicle, {});
  }

  static Cause thruster(simulator::Configuration& to, std::size_t i, double share) {
    to.effectiveness(static_cast<Eigen::Index>(i)) = 1.0 - share;
    return told(CauseKind::thruster, kFirstThruster + i, 1.0 - share);
  }
  static Cause all_thrusters(simulator::Configuration& to, double share) {
    to.effectiveness.setConstant(1.0 - share);
    return told(CauseKind::all_thrusters, 0, 1.0 - share);
  }
  static Cause drag(simulator::Configuration& to, std::size_t axis, double share) {
    to.damping_factor(kBody[axis]) = 1.0 + share;
    return told(CauseKind::drag, axis, 1.0 + share);
  }
  Cause load(simulator::Configuration& to, double ahead_m, double share) const {
    to.payload.mass_kg = share * plant_.mass(0, 0);
    to.payload.buoyancy_n = to.payload.mass_kg * simulator::kGravity;
    to.payload.position_m.x() = ahead_m;
    return told(CauseKind::load, 0, 1.0 + share);
  }
  Cause brake(simulator::Configuration& to, double share) const {
    const double force = 2.0 * share * greatest(simulator::kSurgeLeft);
    to.pull_n.x() = -force;
    return told(CauseKind::force, 0, -force / plant_.mass(0, 0));
  }
  // To starboard, which is negative in the log.
  Cause tether(simulator::Configuration& to, double share) const {
    const double force = share * greatest(simulator::kSway);
    to.pull_n.y() = force;
    to.pull_position_m.x() = -0.5;
    return told(CauseKind::force, 1, -force / plant_.mass(1, 1));
  }
  static Cause scale(simulator::Configuration& to, std::size_t axis, double share) {
    to.sensors.scale(static_cast<Eigen::Index>(axis)) = 1.0 + share;
    return told(CauseKind::sensor_scale, axis, 1.0 + share);
  }
  static Cause bias(simulator::Configuration& to, std::size_t axis, double share) {
    to.sensors.bias(static_cast<Eigen::Index>(axis)) = share * kBiasUnits[axis];
    return told(CauseKind::sensor_bias, axis, share * kBiasUnits[axis]);
  }
  static Cause frozen(simulator::Configuration& to, std::size_t axis) {
    to.sensors.frozen(static_cast<Eigen::Index>(axis)) = 1.0;
    return told(CauseKind::frozen, axis, 0.0);
  }

 private:
  static Cause told(CauseKind kind, std::size_t place, double size) {
    return {kind, place, size, size, size};
  }
  double greatest(std::size_t thruster) const {
    const simulator::Thruster& of = vehicle_.thrusters[thruster];
    return of.forward * of.max_speed_rps * of.max_speed_rps;
  }

  const simulator::VehicleParameters& vehicle_;
  simulator::Plant plant_;
};

}  // namespace

std::vector<DiagnosisCase> diagnosis_cases(const simulator::VehicleParameters& vehicle) {
  const Maker maker(vehicle);
  std::vector<DiagnosisCase> cases;
  const auto add = [&](const std::string& name, int effect, bool special, auto... makes) {
    DiagnosisCase made{name, effect, special, {}, {}};
    made.configuration.name = name;
    (made.truth.push_back(makes(made.configuration)), ...);
    cases.push_back(std::move(made));
  };
  using To = simulator::Configuration&;
  for (const int effect : {20, 40, 60, 80}) {
    const double share = 0.01 * effect;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto th = [share, i](To to) { return Maker::thruster(to, i, share); };
      const auto drag = [share, i](To to) { return Maker::drag(to, i, share); };
      const auto scale = [share, i](To to) { return Maker::scale(to, i, share); };
      const auto bias = [share, i](To to) { return Maker::bias(to, i, share); };
      add(fmt::format("thruster th{}", i + 1), effect, false, th);
      add(fmt::format("drag {}", kAxisNames[i]), effect, false, drag);
      add(fmt::format("scale {}", kSensorNames[i]), effect, false, scale);
      add(fmt::format("bias {}", kSensorNames[i]), effect, false, bias);
    }
    add("all thrusters", effect, false, [&](To to) { return Maker::all_thrusters(to, share); });
    add("load", effect, false, [&](To to) { return maker.load(to, 0.0, share); });
    add("load ahead", effect, true, [&](To to) { return maker.load(to, 0.2, share); });
    add("force surge", effect, false, [&](To to) { return maker.brake(to, share); });
    add("tether", effect, false, [&](To to) { return maker.tether(to, share); });
  }
  for (std::size_t i = 0; i < 3; ++i) {
    add(fmt::format("frozen {}", kSensorNames[i]), 0, false,
        [&](To to) { return Maker::frozen(to, i); });
  }
  const auto th = [&](std::size_t i) { return [i](To to) { return Maker::thruster(to, i, 0.4); }; };
  add("th1 and drag sway", 40, true, th(0), [&](To to) { return Maker::drag(to, 1, 0.4); });
  add("th2 and th3", 40, true, th(1), th(2));
  add("th3 and force surge", 40, true, th(2), [&](To to) { return maker.brake(to, 0.4); });
  add("thruster th1 dead", 100, true, [&](To to) { return Maker::thruster(to, 0, 1.0); });
  add(
      "th1 80 % and th3 50 %", 0, true, [&](To to) { return Maker::thruster(to, 0, 0.8); },
      [&](To to) { return Maker::thruster(to, 2, 0.5); });
  add(
      "th1 and th2 dead", 100, true, [&](To to) { return Maker::thruster(to, 0, 1.0); },
      [&](To to) { return Maker::thruster(to, 1, 1.0); });
  add("th1 and bias r", 40, true, th(0), [&](To to) { return Maker::bias(to, 2, 0.4); });
  return cases;
}

std::string case_name(const Cause& cause) {
  switch (cause.kind) {
    case CauseKind::thruster:
      return fmt::format("thruster th{}", cause.place - kFirstThruster + 1);
    case CauseKind::drag:
      return fmt::format("drag {}", kAxisNames[cause.place]);
    case CauseKind::load:
      return "load";
    case CauseKind::force:
      return "force";
    case CauseKind::sensor_scale:
      return fmt::format("scale {}", kSensorNames[cause.place]);
    case CauseKind::sensor_bias:
      return fmt::format("bias {}", kSensorNames[cause.place]);
    case CauseKind::frozen:
      return fmt::format("frozen {}", kSensorNames[cause.place]);
    case CauseKind::all_thrusters:
      return "all thrusters";
  }
  return "";
}

}  // namespace kelpie::lab
