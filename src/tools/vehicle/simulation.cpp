// SPDX-License-Identifier: Apache-2.0
#include "vehicle/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "vehicle/dynamics.hpp"
#include "vehicle/frames.hpp"
#include "vehicle/pilot.hpp"
#include "vehicle/simulator.hpp"
#include "vehicle/tuning.hpp"

namespace kelpie::vehicle {
namespace {

constexpr std::int64_t kSlowestSensorTicks = kTicksPerSecond / kTuning.least_sensor_rate_hz;
constexpr std::int64_t kProgressTicks = kTuning.progress_every_s * kTicksPerSecond;

// The sensors measure at the rows and evenly between them, at 4 Hz or somewhat faster.
std::int64_t sensor_ticks(std::int64_t row_ticks) {
  std::int64_t ticks = std::min(row_ticks, kSlowestSensorTicks);
  while (row_ticks % ticks != 0) {
    --ticks;
  }
  return ticks;
}

Eigen::Vector3d lateral_max_speeds(const VehicleParameters& vehicle) {
  return {vehicle.thrusters[kSurgeLeft].max_speed_rps, vehicle.thrusters[kSurgeRight].max_speed_rps,
          vehicle.thrusters[kSway].max_speed_rps};
}

// A scenario being driven. `Recorder` sees the vehicle at rest, every change of phase and every
// tick.
template <typename Recorder>
class Mission {
 public:
  Mission(const Scenario& scenario, const Progress& progress)
      : scenario_(scenario),
        progress_(progress),
        all_ticks_(ticks_in(scenario.duration_s())),
        simulator_(scenario.vehicle, plant_of(scenario.phases.front()), scenario.current_m_s,
                   State{}),
        recorder_(scenario, simulator_) {
    if (scenario.excitation.in_plane()) {
      excitation_.emplace(scenario.excitation, lateral_max_speeds(scenario.vehicle), scenario.seed);
    } else {
      pilot_.emplace(scenario.vehicle, scenario.excitation, scenario.seed);
    }
  }

  void drive(std::size_t index) {
    const Phase& phase = scenario_.phases[index];
    const Plant to = plant_of(phase);
    const Plant from = index > 0 ? plant_of(scenario_.phases[index - 1]) : to;
    const std::int64_t ticks = ticks_in(phase.duration_s);
    const std::int64_t ramp_ticks = std::llround(phase.ramp_s * kTicksPerSecond);
    simulator_.set_plant(ramp_ticks > 0 ? from : to);
    recorder_.begin(phase);
    for (std::int64_t tick = 0; tick < ticks; ++tick) {
      if (tick < ramp_ticks) {
        simulator_.set_plant(
            blend(from, to, static_cast<double>(tick + 1) / static_cast<double>(ramp_ticks)));
      }
      advance(phase.amplitude);
      recorder_.record(phase.configuration);
      ++ticks_;
      if (progress_ && (ticks_ % kProgressTicks == 0 || ticks_ == all_ticks_)) {
        progress_(static_cast<double>(ticks_) / static_cast<double>(all_ticks_));
      }
    }
  }

  auto finish() && { return std::move(recorder_).finish(); }

 private:
  Plant plant_of(const Phase& phase) const {
    return make_plant(scenario_.vehicle, scenario_.configurations[phase.configuration]);
  }

  void advance(double amplitude) {
    if (excitation_) {
      simulator_.advance_in_plane(excitation_->advance(kTickS, amplitude));
    } else {
      simulator_.advance(pilot_->advance(simulator_.state(), kTickS, amplitude));
    }
  }

  const Scenario& scenario_;
  const Progress& progress_;
  std::int64_t all_ticks_;
  std::optional<Excitation> excitation_;
  std::optional<Pilot> pilot_;
  Simulator simulator_;
  Recorder recorder_;
  std::int64_t ticks_ = 0;
};

class PlanarRecorder {
 public:
  PlanarRecorder(const Scenario& scenario, const Simulator& simulator)
      : scenario_(scenario),
        simulator_(simulator),
        row_ticks_(ticks_in(1.0 / scenario.rate_hz)),
        sensor_ticks_(sensor_ticks(row_ticks_)),
        sensors_(scenario.noise, scenario.seed) {
    measure();
  }

  void begin(const Phase& phase) {
    sensors_.set_fault(scenario_.configurations[phase.configuration].sensors);
  }

  void record(std::size_t configuration) {
    ++ticks_;
    if (ticks_ % sensor_ticks_ == 0) {
      measure();
    }
    if (ticks_ % row_ticks_ == 0) {
      rows_.push_back({.t_s = simulator_.time_s(),
                       .configuration = configuration,
                       .velocity = measurements_.back(),
                       .rotors_rps = simulator_.state().rotors_rps.head<3>(),
                       .acceleration = Eigen::Vector3d::Zero(),
                       .true_acceleration = planar_flu(simulator_.acceleration())});
    }
  }

  std::vector<LogRow> finish() && {
    const double period_s = static_cast<double>(sensor_ticks_) * kTickS;
    const std::vector<Eigen::Vector3d> slopes =
        smoothed_slopes<3>(measurements_, period_s, kTuning.half_window_s);
    const auto per_row = static_cast<std::size_t>(row_ticks_ / sensor_ticks_);
    for (std::size_t row = 0; row < rows_.size(); ++row) {
      rows_[row].acceleration = slopes[(row + 1) * per_row];
    }
    return std::move(rows_);
  }

 private:
  void measure() {
    measurements_.push_back(sensors_.measure(planar_flu(simulator_.state().velocity)));
  }

  const Scenario& scenario_;
  const Simulator& simulator_;
  std::int64_t row_ticks_, sensor_ticks_;
  VelocitySensors sensors_;
  std::int64_t ticks_ = 0;
  std::vector<Eigen::Vector3d> measurements_;
  std::vector<LogRow> rows_;
};

class SixAxisRecorder {
 public:
  SixAxisRecorder(const Scenario& scenario, const Simulator& simulator)
      : unit_(scenario.vehicle.command_unit),
        simulator_(simulator),
        row_ticks_(ticks_in(1.0 / scenario.rate_hz)),
        sensor_ticks_(sensor_ticks(row_ticks_)),
        sensors_(scenario.noise, scenario.seed) {
    measure();
  }

  void begin(const Phase& /*phase*/) {}  // validate() refuses faults of sensors

  void record(std::size_t configuration) {
    ++ticks_;
    if (ticks_ % sensor_ticks_ == 0) {
      measure();
    }
    if (ticks_ % row_ticks_ == 0) {
      SixAxisRow& row =
          rows_.emplace_back(six_axis_row(simulator_, unit_, measurements_.back(), sensors_));
      row.configuration = configuration;
      row.true_acceleration = simulator_.acceleration();
    }
  }

  std::vector<SixAxisRow> finish() && {
    const double period_s = static_cast<double>(sensor_ticks_) * kTickS;
    const std::vector<Vector6> slopes =
        smoothed_slopes<6>(measurements_, period_s, kTuning.six_half_window_s);
    const auto per_row = static_cast<std::size_t>(row_ticks_ / sensor_ticks_);
    for (std::size_t row = 0; row < rows_.size(); ++row) {
      rows_[row].acceleration = slopes[(row + 1) * per_row];
    }
    return std::move(rows_);
  }

 private:
  void measure() { measurements_.push_back(sensors_.measure(simulator_.state().velocity)); }

  CommandUnit unit_;
  const Simulator& simulator_;
  std::int64_t row_ticks_, sensor_ticks_;
  SixAxisSensors sensors_;
  std::int64_t ticks_ = 0;
  std::vector<Vector6> measurements_;
  std::vector<SixAxisRow> rows_;
};

template <typename Recorder>
auto recorded(const Scenario& scenario, const Progress& progress) {
  scenario.validate();
  Mission<Recorder> mission(scenario, progress);
  for (std::size_t phase = 0; phase < scenario.phases.size(); ++phase) {
    mission.drive(phase);
  }
  return std::move(mission).finish();
}

}  // namespace

SixAxisRow six_axis_row(const Simulator& simulator, CommandUnit unit, const Vector6& velocity,
                        SixAxisSensors& sensors) {
  return {.t_s = simulator.time_s(),
          .configuration = 0,
          .velocity = velocity,
          .attitude_rad = sensors.measure_attitude(euler_angles(simulator.state().attitude)),
          .commands = simulator.commands().unaryExpr(
              [unit](double command) { return command_in_unit(unit, command); }),
          .voltage_v = simulator.voltage_v(),
          .acceleration = Vector6::Zero(),
          .true_acceleration = Vector6::Zero()};
}

std::vector<LogRow> simulate(const Scenario& scenario, const Progress& progress) {
  require_plane(scenario.vehicle);
  return recorded<PlanarRecorder>(scenario, progress);
}

std::vector<SixAxisRow> simulate_six_axes(const Scenario& scenario, const Progress& progress) {
  return recorded<SixAxisRecorder>(scenario, progress);
}

}  // namespace kelpie::vehicle
