// SPDX-License-Identifier: Apache-2.0
#include "vehicle/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vehicle/dynamics.hpp"
#include "vehicle/frames.hpp"
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

// A scenario being driven.
class Mission {
 public:
  Mission(const Scenario& scenario, const Progress& progress)
      : scenario_(scenario),
        progress_(progress),
        row_ticks_(ticks_in(1.0 / scenario.rate_hz)),
        sensor_ticks_(sensor_ticks(row_ticks_)),
        all_ticks_(ticks_in(scenario.duration_s())),
        excitation_(scenario.excitation, lateral_max_speeds(scenario.vehicle), scenario.seed),
        sensors_(scenario.noise, scenario.seed),
        simulator_(scenario.vehicle, plant_of(scenario.phases.front()), scenario.current_m_s,
                   State{}) {
    measure();
  }

  void drive(std::size_t index) {
    const Phase& phase = scenario_.phases[index];
    const Plant to = plant_of(phase);
    const Plant from = index > 0 ? plant_of(scenario_.phases[index - 1]) : to;
    const std::int64_t ticks = ticks_in(phase.duration_s);
    const std::int64_t ramp_ticks = std::llround(phase.ramp_s * kTicksPerSecond);
    simulator_.set_plant(ramp_ticks > 0 ? from : to);
    sensors_.set_fault(scenario_.configurations[phase.configuration].sensors);
    for (std::int64_t tick = 0; tick < ticks; ++tick) {
      if (tick < ramp_ticks) {
        simulator_.set_plant(
            blend(from, to, static_cast<double>(tick + 1) / static_cast<double>(ramp_ticks)));
      }
      simulator_.advance(excitation_.advance(kTickS, phase.amplitude));
      record(phase);
    }
  }

  std::vector<LogRow> finish() && {
    const double period_s = static_cast<double>(sensor_ticks_) * kTickS;
    const std::vector<Eigen::Vector3d> slopes =
        smoothed_slopes(measurements_, period_s, kTuning.half_window_s);
    const auto per_row = static_cast<std::size_t>(row_ticks_ / sensor_ticks_);
    for (std::size_t row = 0; row < rows_.size(); ++row) {
      rows_[row].acceleration = slopes[(row + 1) * per_row];
    }
    return std::move(rows_);
  }

 private:
  Plant plant_of(const Phase& phase) const {
    return make_plant(scenario_.vehicle, scenario_.configurations[phase.configuration]);
  }

  void measure() {
    measurements_.push_back(sensors_.measure(planar_flu(simulator_.state().velocity)));
  }

  void record(const Phase& phase) {
    ++ticks_;
    if (ticks_ % sensor_ticks_ == 0) {
      measure();
    }
    if (ticks_ % row_ticks_ == 0) {
      rows_.push_back({.t_s = simulator_.time_s(),
                       .configuration = phase.configuration,
                       .velocity = measurements_.back(),
                       .rotors_rps = simulator_.state().rotors_rps.head<3>(),
                       .acceleration = Eigen::Vector3d::Zero(),
                       .true_acceleration = planar_flu(simulator_.acceleration())});
    }
    if (progress_ && (ticks_ % kProgressTicks == 0 || ticks_ == all_ticks_)) {
      progress_(static_cast<double>(ticks_) / static_cast<double>(all_ticks_));
    }
  }

  const Scenario& scenario_;
  const Progress& progress_;
  std::int64_t row_ticks_, sensor_ticks_, all_ticks_;
  Excitation excitation_;
  VelocitySensors sensors_;
  Simulator simulator_;
  std::int64_t ticks_ = 0;
  std::vector<Eigen::Vector3d> measurements_;
  std::vector<LogRow> rows_;
};

}  // namespace

std::vector<LogRow> simulate(const Scenario& scenario, const Progress& progress) {
  scenario.validate();
  Mission mission(scenario, progress);
  for (std::size_t phase = 0; phase < scenario.phases.size(); ++phase) {
    mission.drive(phase);
  }
  return std::move(mission).finish();
}

}  // namespace kelpie::vehicle
