// SPDX-License-Identifier: Apache-2.0
#include "lab/drive_study.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "core/quantile.hpp"
#include "jobs/run_all.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "lab/planar_truth.hpp"
#include "simulator/excitation.hpp"
#include "simulator/frames.hpp"
#include "simulator/pilot.hpp"
#include "simulator/sensors.hpp"
#include "simulator/simulation.hpp"
#include "simulator/simulator.hpp"
#include "study/six_axes.hpp"

namespace kelpie::lab {
namespace {

constexpr double kShortestS = 5.0;  // a manoeuvre
constexpr double kStricter = 0.8;   // of the wanted share
constexpr double kStickS = 0.5;     // lag of a pilot's hand, as simulator::Pilot's
constexpr int kMostTries = 200;     // of a draw that leaves the bounds
constexpr double kSmaller = 0.97;   // of the amplitude after such a draw

// The simulated vehicle under way, and the rows of its log.
class LoggedDrive {
 public:
  explicit LoggedDrive(const simulator::Scenario& scenario)
      : ticks_per_row_(static_cast<std::int64_t>(
            std::llround(static_cast<double>(simulator::kTicksPerSecond) / scenario.rate_hz))),
        simulator_(scenario.vehicle,
                   simulator::make_plant(scenario.vehicle, scenario.configurations.front()),
                   scenario.current_m_s, simulator::State{}) {}
  virtual ~LoggedDrive() = default;
  LoggedDrive(const LoggedDrive&) = delete;
  LoggedDrive& operator=(const LoggedDrive&) = delete;

  // In the unit of the fit.
  virtual study::ThrusterRange range() const = 0;
  virtual study::DriveMotion motion() const = 0;
  virtual std::vector<double> truth() const = 0;
  // Of the rows so far, with a scale. Throws InputError on too little excitation.
  virtual ParameterFit identified() const = 0;
  virtual void give_scale(ParameterFit& fit) const = 0;
  virtual std::unique_ptr<ExpectedFit> expected() const = 0;
  virtual std::unique_ptr<study::DrivableVehicle> vehicle_of(const ExpectedFit& expected) const = 0;

  void drive(const std::vector<double>& speeds, double duration_s) {
    const auto ticks = static_cast<std::int64_t>(std::llround(duration_s / simulator::kTickS));
    for (std::int64_t i = 0; i < ticks; ++i) {
      advance(speeds);
      note_tick();
    }
  }

  // The drive before, by the scenario's driver. Bounds count from its end.
  void drive_first(double duration_s) {
    for (double t = 0.0; t < duration_s - 1e-9; t += simulator::kTickS) {
      advance_first();
      note_tick();
    }
    origin_ = simulator_.state().position_m;
    extent_ = {};
  }

  double time_s() const { return simulator_.time_s(); }
  const study::DriveExtent& extent() const { return extent_; }

 protected:
  virtual void advance(const std::vector<double>& speeds) = 0;
  virtual void advance_first() = 0;
  virtual void log() = 0;

  Eigen::Vector3d position_m() const { return simulator_.state().position_m - origin_; }

  std::int64_t ticks_per_row_;
  simulator::Simulator simulator_;

 private:
  void note_tick() {
    extent_.include(motion());
    if (++ticks_ % ticks_per_row_ == 0) {
      log();
    }
  }

  std::int64_t ticks_ = 0;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  study::DriveExtent extent_;
};

class PlanarLoggedDrive : public LoggedDrive {
 public:
  PlanarLoggedDrive(const simulator::Scenario& scenario, std::uint64_t seed)
      : LoggedDrive(scenario),
        scenario_(scenario),
        sensors_(scenario.noise, seed),
        known_{{"th1", scenario.vehicle.thrusters[simulator::kSurgeLeft].forward}} {
    rows_.thrusters = {"th1", "th2", "th3"};
    Eigen::Vector3d most;
    for (Eigen::Index i = 0; i < 3; ++i) {
      most(i) = scenario.vehicle.thrusters[static_cast<std::size_t>(i)].max_speed_rps;
      range_.least.push_back(-most(i));
      range_.most.push_back(most(i));
    }
    first_.emplace(scenario.excitation, most, seed);
  }

  study::ThrusterRange range() const override { return range_; }
  study::DriveMotion motion() const override {
    const simulator::State& state = simulator_.state();
    const Eigen::Matrix3d to_world = state.attitude.toRotationMatrix();
    const Eigen::Vector3d velocity = simulator::planar_flu(state.velocity);
    const Eigen::Vector3d position = position_m();
    return {.velocity = {velocity(0), velocity(1), 0.0, 0.0, 0.0, velocity(2)},
            .position_m = {position.x(), -position.y(), 0.0},
            .angles_rad = {0.0, 0.0, -std::atan2(to_world(1, 0), to_world(0, 0))}};
  }
  std::vector<double> truth() const override { return planar_truth(scenario_); }
  ParameterFit identified() const override { return scaled_by_thrust(fit_planar(rows_), known_); }
  void give_scale(ParameterFit& fit) const override { scale_by_thrust(fit, known_); }
  std::unique_ptr<ExpectedFit> expected() const override {
    return std::make_unique<ExpectedPlanarFit>(rows_);
  }
  std::unique_ptr<study::DrivableVehicle> vehicle_of(const ExpectedFit& expected) const override {
    return std::make_unique<study::DrivablePlanarVehicle>(
        dynamic_cast<const ExpectedPlanarFit&>(expected), range_, 1.0 / scenario_.rate_hz);
  }

 private:
  void advance(const std::vector<double>& speeds) override {
    simulator_.advance_in_plane(Eigen::Map<const Eigen::Vector3d>(speeds.data()));
  }
  void advance_first() override {
    simulator_.advance_in_plane(first_->advance(simulator::kTickS, 1.0));
  }
  void log() override {
    const Eigen::Vector3d velocity =
        sensors_.measure(simulator::planar_flu(simulator_.state().velocity));
    rows_.times_s.push_back(simulator_.time_s());
    rows_.velocities.insert(rows_.velocities.end(), velocity.begin(), velocity.end());
    const auto rotors = simulator_.state().rotors_rps.head<3>();
    rows_.speeds.insert(rows_.speeds.end(), rotors.begin(), rotors.end());
  }

  const simulator::Scenario& scenario_;
  simulator::VelocitySensors sensors_;
  std::vector<std::pair<std::string, double>> known_;
  study::ThrusterRange range_;
  std::optional<simulator::Excitation> first_;
  PlanarRows rows_;
};

// Commands are shares of full; the scale is the true surge inertia.
class SixAxisLoggedDrive : public LoggedDrive {
 public:
  SixAxisLoggedDrive(const simulator::Scenario& scenario, std::uint64_t seed)
      : LoggedDrive(scenario),
        vehicle_(scenario.vehicle),
        sensors_(scenario.noise, seed),
        first_(scenario.vehicle, scenario.excitation, seed) {}

  study::ThrusterRange range() const override {
    const std::size_t count = vehicle_.thrusters.size();
    return {std::vector(count, -1.0), std::vector(count, 1.0)};
  }
  study::DriveMotion motion() const override {
    const simulator::State& state = simulator_.state();
    const Eigen::Vector3d angles = simulator::euler_angles(state.attitude);
    const Eigen::Vector3d position = position_m();
    study::DriveMotion motion{.position_m = {position.x(), position.y(), position.z()},
                              .angles_rad = {angles.x(), angles.y(), angles.z()}};
    std::ranges::copy(state.velocity, motion.velocity.begin());
    return motion;
  }
  std::vector<double> truth() const override { return study::six_axis_truth(vehicle_); }
  ParameterFit identified() const override {
    ParameterFit fit = fit_six_axes(study::six_axis_rows(log_, vehicle_));
    give_scale(fit);
    return fit;
  }
  void give_scale(ParameterFit& fit) const override {
    scale_by_inertia(fit, study::six_axis_truth(vehicle_).front(), 0.0);
  }
  std::unique_ptr<ExpectedFit> expected() const override {
    return std::make_unique<ExpectedSixAxisFit>(study::six_axis_rows(log_, vehicle_));
  }
  std::unique_ptr<study::DrivableVehicle> vehicle_of(const ExpectedFit& expected) const override {
    const double nominal_v = vehicle_.battery.nominal_v;
    return std::make_unique<study::DrivableSixAxisVehicle>(
        dynamic_cast<const ExpectedSixAxisFit&>(expected), range(),
        nominal_v > 0.0 ? log_.back().voltage_v / nominal_v : 1.0);
  }

 private:
  void advance(const std::vector<double>& speeds) override {
    simulator::RotorSpeeds commands(static_cast<Eigen::Index>(speeds.size()));
    for (std::size_t i = 0; i < speeds.size(); ++i) {
      commands(static_cast<Eigen::Index>(i)) = speeds[i] * vehicle_.thrusters[i].max_speed_rps;
    }
    simulator_.advance(commands);
  }
  void advance_first() override {
    simulator_.advance(first_.advance(simulator_.state(), simulator::kTickS, 1.0));
  }
  void log() override {
    const simulator::Vector6 velocity = sensors_.measure(simulator_.state().velocity);
    log_.push_back(simulator::six_axis_row(simulator_, vehicle_.command_unit, velocity, sensors_));
  }

  const simulator::VehicleParameters& vehicle_;
  simulator::SixAxisSensors sensors_;
  simulator::Pilot first_;
  std::vector<simulator::SixAxisRow> log_;
};

std::unique_ptr<LoggedDrive> logged_drive(const simulator::Scenario& scenario, std::uint64_t seed) {
  if (scenario.log == simulator::LogKind::six) {
    return std::make_unique<SixAxisLoggedDrive>(scenario, seed);
  }
  return std::make_unique<PlanarLoggedDrive>(scenario, seed);
}

// Draws of one driver that is no plan.
class FreeDriver {
 public:
  FreeDriver(Driver driver, std::uint64_t seed) : driver_(driver), random_(seed, "driver") {}

  study::Manoeuvre draw(const study::ThrusterPush& push, double amplitude) {
    study::Manoeuvre manoeuvre =
        driver_ == Driver::random ? at_random(push.range(), amplitude) : piloted(push, amplitude);
    for (study::HeldSpeeds& part : manoeuvre.parts) {
      part.speeds = push.held(std::move(part.speeds));
    }
    return manoeuvre;
  }

  // The last draw is driven.
  void taken() { stick_ = last_; }

 private:
  double hold(double longest_s) {
    return study::kManoeuvreStepS *
           std::round(random_.uniform(1.0, longest_s) / study::kManoeuvreStepS);
  }

  study::Manoeuvre at_random(const study::ThrusterRange& range, double amplitude) {
    std::vector<double> speeds;
    for (std::size_t i = 0; i < range.most.size(); ++i) {
      speeds.push_back(amplitude * random_.uniform(range.least[i], range.most[i]));
    }
    return {"random", {{hold(8.0), std::move(speeds)}}};
  }

  study::Manoeuvre piloted(const study::ThrusterPush& push, double amplitude) {
    std::vector<double> wish(push.axes());
    for (double& level : wish) {
      level = amplitude * random_.uniform(-1.0, 1.0);
    }
    study::Manoeuvre manoeuvre{"pilot", {}};
    std::vector<double> stick = stick_;
    stick.resize(push.axes(), 0.0);
    for (double left_s = hold(6.0); left_s > 0.0; left_s -= study::kManoeuvreStepS) {
      double most = 0.0;
      for (std::size_t axis = 0; axis < stick.size(); ++axis) {
        stick[axis] +=
            (1.0 - std::exp(-study::kManoeuvreStepS / kStickS)) * (wish[axis] - stick[axis]);
        most = std::max(most, std::abs(stick[axis]));
      }
      manoeuvre.parts.push_back({study::kManoeuvreStepS, push.speeds(stick, most)});
    }
    last_ = stick;
    return manoeuvre;
  }

  Driver driver_;
  RandomStream random_;
  std::vector<double> stick_, last_;
};

// One drive of one driver and seed.
class StudiedDrive {
 public:
  StudiedDrive(const DriveStudyPlan& plan, Driver driver, std::uint64_t seed)
      : plan_(plan),
        driver_(driver),
        free_(driver, seed),
        log_(logged_drive(plan.scenario, seed)),
        truth_(log_->truth()) {
    log_->drive_first(plan.first_s);
  }

  DriveOutcome run() {
    check();
    while (!outcome_.told && driven_s() < plan_.bounds.time_s - kShortestS) {
      drive_leg();
    }
    outcome_.extent = log_->extent();
    return outcome_;
  }

 private:
  double driven_s() const { return log_->time_s() - plan_.first_s; }

  void drive_leg() {
    const std::unique_ptr<ExpectedFit> expected = log_->expected();
    const std::unique_ptr<study::DrivableVehicle> vehicle = log_->vehicle_of(*expected);
    study::DriveBounds bounds = plan_.bounds;
    bounds.time_s = std::min(plan_.leg_s, plan_.bounds.time_s - driven_s());
    if (driver_ == Driver::planned) {
      drive_plan(*vehicle, bounds);
      return;
    }
    study::PossibleVehicles possible(*vehicle, bounds, log_->motion());
    for (double left_s = bounds.time_s; left_s > 1e-9;) {
      const study::Manoeuvre manoeuvre = free_manoeuvre(possible, vehicle->push());
      left_s -= manoeuvre.duration_s();
      drive(manoeuvre);
    }
  }

  // Parameters that are asked for and that the vehicle has.
  std::vector<std::size_t> wanted(const ParameterFit& fit) const {
    std::vector<std::size_t> places = study::wanted_places(fit, plan_.tell);
    std::erase_if(places, [this](std::size_t place) { return truth_[place] == 0.0; });
    return places;
  }

  // Where the plan expects that all is told but identify does not say so, more is asked of it. A
  // vehicle that would coast out of the bounds has no plan, and rests.
  void drive_plan(const study::DrivableVehicle& vehicle, const study::DriveBounds& bounds) {
    const ExpectedFit& expected = vehicle.expected();
    study::DrivePlan leg;
    try {
      for (double share = plan_.share; leg.manoeuvres.empty(); share *= kStricter) {
        const study::DriveGoal goal =
            study::telling_goal(expected, wanted(expected.now()), share,
                                [&](ParameterFit& fit) { log_->give_scale(fit); });
        leg = study::plan_drive(vehicle, bounds, goal, log_->motion());
      }
    } catch (const InputError&) {
      drive(rest(vehicle.push()));
      return;
    }
    for (const study::Manoeuvre& manoeuvre : leg.manoeuvres) {
      drive(manoeuvre);
    }
    note_expected(leg);
  }

  static study::Manoeuvre rest(const study::ThrusterPush& push) {
    return {"rest", {{kShortestS, push.held(std::vector<double>(push.range().most.size(), 0.0))}}};
  }

  study::Manoeuvre free_manoeuvre(study::PossibleVehicles& possible,
                                  const study::ThrusterPush& push) {
    double amplitude = 1.0;
    for (int i = 0; i < kMostTries; ++i) {
      study::Manoeuvre manoeuvre = free_.draw(push, amplitude);
      if (possible.drive(manoeuvre)) {
        free_.taken();
        return manoeuvre;
      }
      amplitude *= kSmaller;
    }
    return rest(push);
  }

  void drive(const study::Manoeuvre& manoeuvre) {
    for (const study::HeldSpeeds& part : manoeuvre.parts) {
      for (double left_s = part.duration_s; left_s > 1e-9 && !outcome_.told;
           left_s -= study::kManoeuvreStepS) {
        log_->drive(part.speeds, study::kManoeuvreStepS);
        if (driven_s() >= next_check_s_ - 1e-9) {
          check();
        }
      }
    }
  }

  // Whether kelpie identify tells all by now.
  void check() {
    next_check_s_ = driven_s() + plan_.check_s;
    ParameterFit fit;
    try {
      fit = log_->identified();
    } catch (const InputError&) {
      return;  // too little excitation so far
    }
    double worst = 0.0;
    double squares = 0.0;
    const std::vector<std::size_t> places = wanted(fit);
    for (const std::size_t place : places) {
      const FittedParameter& parameter = fit.parameters[place];
      worst = std::max(worst, parameter.state == ParameterState::identified
                                  ? study::interval_share(fit, place)
                                  : 10.0);
      squares += std::pow((parameter.value - truth_[place]) / truth_[place], 2.0);
    }
    outcome_.times_s.push_back(driven_s());
    outcome_.worst.push_back(worst);
    outcome_.told_s = driven_s();
    outcome_.told = worst <= plan_.share;
    outcome_.error = std::sqrt(squares / static_cast<double>(places.size()));
  }

  // The median over the wanted parameters.
  void note_expected(const study::DrivePlan& leg) {
    if (outcome_.expected > 0.0) {
      return;
    }
    const ParameterFit fit = log_->identified();
    std::vector<double> ratios;
    for (std::size_t i = 0; i < leg.names.size(); ++i) {
      const auto found = std::ranges::find(fit.parameters, leg.names[i], &FittedParameter::name);
      ratios.push_back(
          leg.countdown.back().numbers[i] /
          study::interval_share(fit, static_cast<std::size_t>(found - fit.parameters.begin())));
    }
    outcome_.expected = quantile(ratios, 0.5);
  }

  const DriveStudyPlan& plan_;
  Driver driver_;
  FreeDriver free_;
  std::unique_ptr<LoggedDrive> log_;
  std::vector<double> truth_;
  double next_check_s_ = 0.0;
  DriveOutcome outcome_;
};

}  // namespace

std::string driver_name(Driver driver) {
  switch (driver) {
    case Driver::planned:
      return "planned";
    case Driver::random:
      return "uniform random";
    case Driver::pilot:
      return "pilot, free";
  }
  return {};
}

DriveStudy study_drives(const DriveStudyPlan& plan) {
  DriveStudy study;
  study.seeds.resize(plan.seeds);
  const auto drive = [&](std::size_t job) {
    const std::size_t seed = job / kDrivers.size();
    const std::size_t which = job % kDrivers.size();
    study.seeds[seed][which] = StudiedDrive(plan, kDrivers[which], plan.scenario.seed + seed).run();
  };
  study.interrupted =
      !jobs::run_while(plan.keep_going, plan.seeds * kDrivers.size(), plan.threads, drive);
  return study;
}

}  // namespace kelpie::lab
