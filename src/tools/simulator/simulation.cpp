// SPDX-License-Identifier: Apache-2.0
#include "simulator/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <optional>
#include <utility>

#include "simulator/dynamics.hpp"
#include "simulator/frames.hpp"
#include "simulator/pilot.hpp"
#include "simulator/simulator.hpp"
#include "simulator/tuning.hpp"

namespace kelpie::simulator {
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

// A scenario being driven. `Watcher` sees the vehicle at rest, every change of phase and every
// tick.
template <typename Watcher>
class Mission {
 public:
  Mission(const Scenario& scenario, const Progress& progress)
      : scenario_(scenario),
        progress_(progress),
        all_ticks_(ticks_in(scenario.duration_s())),
        simulator_(scenario.vehicle, plant_of(scenario.phases.front()), scenario.current_m_s,
                   State{}),
        watcher_(scenario, simulator_) {
    if (scenario.excitation.in_plane()) {
      excitation_.emplace(scenario.excitation, lateral_max_speeds(scenario.vehicle), scenario.seed);
    } else {
      pilot_.emplace(scenario.vehicle, scenario.excitation, scenario.seed);
    }
  }

  // Drives for a tick. False at the end.
  bool step() {
    while (phase_tick_ == phase_ticks_) {
      if (next_phase_ == scenario_.phases.size()) {
        return false;
      }
      begin_phase();
    }
    const Phase& phase = scenario_.phases[next_phase_ - 1];
    ++phase_tick_;
    if (phase_tick_ <= ramp_ticks_) {
      simulator_.set_plant(
          blend(from_, to_, static_cast<double>(phase_tick_) / static_cast<double>(ramp_ticks_)));
    }
    advance(phase.amplitude);
    watcher_.record(phase.configuration);
    ++ticks_;
    if (progress_ && (ticks_ % kProgressTicks == 0 || ticks_ == all_ticks_)) {
      progress_(static_cast<double>(ticks_) / static_cast<double>(all_ticks_));
    }
    return true;
  }

  Watcher& watcher() { return watcher_; }

 private:
  Plant plant_of(const Phase& phase) const {
    return make_plant(scenario_.vehicle, scenario_.configurations[phase.configuration]);
  }

  void begin_phase() {
    const Phase& phase = scenario_.phases[next_phase_];
    to_ = plant_of(phase);
    from_ = next_phase_ > 0 ? plant_of(scenario_.phases[next_phase_ - 1]) : to_;
    phase_ticks_ = ticks_in(phase.duration_s);
    ramp_ticks_ = std::llround(phase.ramp_s * kTicksPerSecond);
    simulator_.set_plant(ramp_ticks_ > 0 ? from_ : to_);
    watcher_.begin(phase);
    phase_tick_ = 0;
    ++next_phase_;
  }

  void advance(double amplitude) {
    if (excitation_) {
      simulator_.advance_in_plane(excitation_->advance(kTickS, amplitude));
    } else {
      simulator_.advance(pilot_->advance(simulator_.state(), kTickS, amplitude));
    }
  }

  const Scenario& scenario_;
  Progress progress_;
  std::int64_t all_ticks_;
  std::optional<Excitation> excitation_;
  std::optional<Pilot> pilot_;
  Simulator simulator_;
  Watcher watcher_;
  std::int64_t ticks_ = 0;
  std::size_t next_phase_ = 0;
  Plant from_, to_;  // of the present phase, as the members below
  std::int64_t phase_tick_ = 0, phase_ticks_ = 0, ramp_ticks_ = 0;
};

// Rows at their rate, of velocities that are measured at the sensors' rate. `Kind` tells how a
// velocity is read, and makes the rows.
template <typename Kind>
class Recorder {
 public:
  Recorder(const Scenario& scenario, const Simulator& simulator)
      : scenario_(scenario),
        simulator_(simulator),
        row_ticks_(ticks_in(1.0 / scenario.rate_hz)),
        sensor_ticks_(sensor_ticks(row_ticks_)),
        half_(static_cast<std::size_t>(std::max(1L, std::lround(Kind::kHalfWindowS / period_s())))),
        sensors_(scenario.noise, scenario.seed) {
    measure();
  }

  void begin(const Phase& phase) {
    Kind::set_fault(sensors_, scenario_.configurations[phase.configuration]);
  }

  void record(std::size_t configuration) {
    ++ticks_;
    if (ticks_ % sensor_ticks_ == 0) {
      measure();
    }
    if (ticks_ % row_ticks_ == 0) {
      rows_.push_back(Kind::row(scenario_, simulator_, measurements_.back(), sensors_));
      rows_.back().configuration = configuration;
    }
  }

  // The oldest row, once all measurements of its acceleration are there, or `is_end`.
  std::optional<typename Kind::Row> next(bool is_end) {
    if (rows_.empty() || (!is_end && at_ + half_ >= measurements_.size())) {
      return std::nullopt;
    }
    typename Kind::Row row = std::move(rows_.front());
    rows_.pop_front();
    row.acceleration =
        smoothed_slope<Kind::Velocity::RowsAtCompileTime>(measurements_, at_, half_, period_s());
    at_ += per_row();
    forget();
    return row;
  }

 private:
  std::size_t per_row() const { return static_cast<std::size_t>(row_ticks_ / sensor_ticks_); }

  // The measurements before all windows to come, many at once: those behind have to move.
  void forget() {
    constexpr std::size_t kMost = 10'000;
    if (at_ > half_ + kMost) {
      measurements_.erase(measurements_.begin(),
                          measurements_.begin() + static_cast<std::ptrdiff_t>(at_ - half_));
      at_ = half_;
    }
  }

  double period_s() const { return static_cast<double>(sensor_ticks_) * kTickS; }
  void measure() { measurements_.push_back(sensors_.measure(Kind::velocity(simulator_))); }

  const Scenario& scenario_;
  const Simulator& simulator_;
  std::int64_t row_ticks_, sensor_ticks_;
  std::size_t half_;  // measurements of a window
  typename Kind::Sensors sensors_;
  std::int64_t ticks_ = 0;
  std::vector<typename Kind::Velocity> measurements_;
  std::deque<typename Kind::Row> rows_;
  std::size_t at_ = per_row();  // the measurement of the oldest row
};

struct InPlane {
  using Row = LogRow;
  using Sensors = VelocitySensors;
  using Velocity = Eigen::Vector3d;
  static constexpr double kHalfWindowS = kTuning.half_window_s;

  static void set_fault(Sensors& sensors, const Configuration& configuration) {
    sensors.set_fault(configuration.sensors);
  }
  static Velocity velocity(const Simulator& simulator) {
    return planar_flu(simulator.state().velocity);
  }
  static Row row(const Scenario& /*scenario*/, const Simulator& simulator, const Velocity& measured,
                 Sensors& /*sensors*/) {
    return {.t_s = simulator.time_s(),
            .configuration = 0,
            .velocity = measured,
            .rotors_rps = simulator.state().rotors_rps.head<3>(),
            .acceleration = Velocity::Zero(),
            .true_acceleration = planar_flu(simulator.acceleration())};
  }
};

struct OnSixAxes {
  using Row = SixAxisRow;
  using Sensors = SixAxisSensors;
  using Velocity = Vector6;
  static constexpr double kHalfWindowS = kTuning.six_half_window_s;

  // validate() refuses faults of sensors.
  static void set_fault(Sensors& /*sensors*/, const Configuration& /*configuration*/) {}
  static Velocity velocity(const Simulator& simulator) { return simulator.state().velocity; }
  static Row row(const Scenario& scenario, const Simulator& simulator, const Velocity& measured,
                 Sensors& sensors) {
    Row row = six_axis_row(simulator, scenario.vehicle.command_unit, measured, sensors);
    row.true_acceleration = simulator.acceleration();
    return row;
  }
};

const Scenario& validated(const Scenario& scenario) {
  scenario.validate();
  return scenario;
}

template <typename Kind>
class Drive {
 public:
  Drive(const Scenario& scenario, const Progress& progress)
      : mission_(validated(scenario), progress) {}

  std::optional<typename Kind::Row> next() {
    std::optional<typename Kind::Row> row = mission_.watcher().next(is_over_);
    while (!row && !is_over_) {
      is_over_ = !mission_.step();
      row = mission_.watcher().next(is_over_);
    }
    return row;
  }

 private:
  Mission<Recorder<Kind>> mission_;
  bool is_over_ = false;
};

template <typename Kind>
auto recorded(const Scenario& scenario, const Progress& progress) {
  std::vector<typename Kind::Row> rows;
  Drive<Kind> drive(scenario, progress);
  while (auto row = drive.next()) {
    rows.push_back(std::move(*row));
  }
  return rows;
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

RowSource drive_in_plane(Scenario scenario) {
  require_plane(scenario.vehicle);
  const auto driven = std::make_shared<const Scenario>(std::move(scenario));
  const auto drive = std::make_shared<Drive<InPlane>>(*driven, Progress());
  return [driven, drive] { return drive->next(); };
}

std::vector<LogRow> simulate(const Scenario& scenario, const Progress& progress) {
  require_plane(scenario.vehicle);
  return recorded<InPlane>(scenario, progress);
}

std::vector<SixAxisRow> simulate_six_axes(const Scenario& scenario, const Progress& progress) {
  return recorded<OnSixAxes>(scenario, progress);
}

}  // namespace kelpie::simulator
