// SPDX-License-Identifier: Apache-2.0
#include "lab/drive_study.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <utility>

#include "core/quantile.hpp"
#include "jobs/run_all.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "lab/planar_truth.hpp"
#include "vehicle/excitation.hpp"
#include "vehicle/frames.hpp"
#include "vehicle/sensors.hpp"
#include "vehicle/simulator.hpp"

namespace kelpie::lab {
namespace {

constexpr double kCheckS = 5.0;     // between identifications
constexpr double kShortestS = 5.0;  // a manoeuvre
constexpr double kStricter = 0.8;   // of the wanted share
constexpr double kStickS = 0.5;     // lag of a pilot's hand, as vehicle::Pilot's
constexpr int kMostTries = 200;     // of a draw that leaves the bounds
constexpr double kSmaller = 0.97;   // of the amplitude after such a draw

// The simulated vehicle in the plane under way, and the rows of its log.
class LoggedDrive {
 public:
  LoggedDrive(const vehicle::Scenario& scenario, std::uint64_t seed)
      : ticks_per_row_(static_cast<std::int64_t>(
            std::llround(static_cast<double>(vehicle::kTicksPerSecond) / scenario.rate_hz))),
        simulator_(scenario.vehicle,
                   vehicle::make_plant(scenario.vehicle, scenario.configurations.front()),
                   scenario.current_m_s, vehicle::State{}),
        sensors_(scenario.noise, seed) {
    rows_.thrusters = {"th1", "th2", "th3"};
  }

  void drive(const Eigen::Vector3d& speeds, double duration_s) {
    const auto ticks = static_cast<std::int64_t>(std::llround(duration_s / vehicle::kTickS));
    for (std::int64_t i = 0; i < ticks; ++i) {
      simulator_.advance_in_plane(speeds);
      const study::PlanarMotion at = motion();
      farthest_m_ = std::max(farthest_m_, std::hypot(at.x_m, at.y_m));
      fastest_m_s_ = std::max(fastest_m_s_, std::hypot(at.velocity[0], at.velocity[1]));
      if (++ticks_ % ticks_per_row_ == 0) {
        log();
      }
    }
  }

  // Bounds count from here.
  void begin() {
    origin_ = {motion().x_m, motion().y_m};
    farthest_m_ = 0.0;
    fastest_m_s_ = 0.0;
  }

  study::PlanarMotion motion() const {
    const vehicle::State& state = simulator_.state();
    const Eigen::Matrix3d to_world = state.attitude.toRotationMatrix();
    const Eigen::Vector3d velocity = vehicle::planar_flu(state.velocity);
    return {.velocity = {velocity(0), velocity(1), velocity(2)},
            .x_m = state.position_m.x() - origin_[0],
            .y_m = -state.position_m.y() - origin_[1],
            .heading_rad = -std::atan2(to_world(1, 0), to_world(0, 0))};
  }

  const PlanarRows& rows() const { return rows_; }
  double time_s() const { return simulator_.time_s(); }
  double farthest_m() const { return farthest_m_; }
  double fastest_m_s() const { return fastest_m_s_; }

 private:
  void log() {
    const Eigen::Vector3d velocity =
        sensors_.measure(vehicle::planar_flu(simulator_.state().velocity));
    rows_.times_s.push_back(simulator_.time_s());
    rows_.velocities.insert(rows_.velocities.end(), velocity.begin(), velocity.end());
    const auto rotors = simulator_.state().rotors_rps.head<3>();
    rows_.speeds.insert(rows_.speeds.end(), rotors.begin(), rotors.end());
  }

  std::int64_t ticks_per_row_;
  vehicle::Simulator simulator_;
  vehicle::VelocitySensors sensors_;
  PlanarRows rows_;
  std::int64_t ticks_ = 0;
  std::array<double, 2> origin_{};
  double farthest_m_ = 0.0;
  double fastest_m_s_ = 0.0;
};

// Draws of one driver that is no plan.
class FreeDriver {
 public:
  FreeDriver(Driver driver, std::uint64_t seed) : driver_(driver), random_(seed, "driver") {}

  study::Manoeuvre draw(const study::PlanarPush& push, double amplitude) {
    return driver_ == Driver::random ? at_random(push.range(), amplitude)
                                     : piloted(push, amplitude);
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

  study::Manoeuvre piloted(const study::PlanarPush& push, double amplitude) {
    PlanarVector wish{};
    for (double& level : wish) {
      level = amplitude * random_.uniform(-1.0, 1.0);
    }
    study::Manoeuvre manoeuvre{"pilot", {}};
    PlanarVector stick = stick_;
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
  PlanarVector stick_{}, last_{};
};

// One drive of one driver and seed.
class StudiedDrive {
 public:
  StudiedDrive(const DriveStudyPlan& plan, Driver driver, std::uint64_t seed)
      : plan_(plan),
        driver_(driver),
        free_(driver, seed),
        log_(plan.scenario, seed),
        truth_(planar_truth(plan.scenario)),
        known_{{"th1", plan.scenario.vehicle.thrusters[vehicle::kSurgeLeft].forward}} {
    for (std::size_t i = 0; i < 3; ++i) {
      const double most = plan.scenario.vehicle.thrusters[i].max_speed_rps;
      range_.least.push_back(-most);
      range_.most.push_back(most);
    }
    vehicle::Excitation excitation(plan.scenario.excitation,
                                   Eigen::Vector3d(range_.most[0], range_.most[1], range_.most[2]),
                                   seed);
    for (double t = 0.0; t < plan.first_s - 1e-9; t += vehicle::kTickS) {
      log_.drive(excitation.advance(vehicle::kTickS, 1.0), vehicle::kTickS);
    }
    log_.begin();
  }

  DriveOutcome run() {
    check();
    while (!outcome_.told && driven_s() < plan_.bounds.time_s - kShortestS) {
      drive_leg();
    }
    outcome_.farthest_m = log_.farthest_m();
    outcome_.fastest_m_s = log_.fastest_m_s();
    return outcome_;
  }

 private:
  double driven_s() const { return log_.time_s() - plan_.first_s; }

  void drive_leg() {
    const ExpectedPlanarFit expected(log_.rows());
    const study::PlanarPush push(expected.now().vehicle(), range_);
    study::DriveBounds bounds = plan_.bounds;
    bounds.time_s = std::min(plan_.leg_s, plan_.bounds.time_s - driven_s());
    if (driver_ == Driver::planned) {
      drive_plan(expected, push, bounds);
      return;
    }
    study::PossibleVehicles possible(expected.now(), bounds, log_.motion());
    for (double left_s = bounds.time_s; left_s > 1e-9;) {
      const study::Manoeuvre manoeuvre = free_manoeuvre(possible, push);
      left_s -= manoeuvre.duration_s();
      drive(manoeuvre);
    }
  }

  // Where the plan expects that all is told but identify does not say so, more is asked of it. A
  // vehicle that would coast out of the bounds has no plan, and rests.
  void drive_plan(const ExpectedPlanarFit& expected, const study::PlanarPush& push,
                  const study::DriveBounds& bounds) {
    study::DrivePlan leg;
    try {
      for (double share = plan_.share; leg.manoeuvres.empty(); share *= kStricter) {
        const study::DriveGoal goal =
            study::telling_goal(expected, study::wanted_places(expected.now(), plan_.tell), share,
                                [&](PlanarFit& fit) { scale_by_thrust(fit, known_); });
        leg = study::plan_drive(expected.now(), push, bounds, goal, 1.0 / plan_.scenario.rate_hz,
                                log_.motion());
      }
    } catch (const InputError&) {
      drive({"rest", {{kShortestS, std::vector<double>(range_.most.size(), 0.0)}}});
      return;
    }
    for (const study::Manoeuvre& manoeuvre : leg.manoeuvres) {
      drive(manoeuvre);
    }
    note_expected(leg);
  }

  study::Manoeuvre free_manoeuvre(study::PossibleVehicles& possible,
                                  const study::PlanarPush& push) {
    double amplitude = 1.0;
    for (int i = 0; i < kMostTries; ++i) {
      study::Manoeuvre manoeuvre = free_.draw(push, amplitude);
      if (possible.drive(manoeuvre)) {
        free_.taken();
        return manoeuvre;
      }
      amplitude *= kSmaller;
    }
    return {"rest", {{kShortestS, std::vector<double>(range_.most.size(), 0.0)}}};
  }

  void drive(const study::Manoeuvre& manoeuvre) {
    for (const study::HeldSpeeds& part : manoeuvre.parts) {
      for (double left_s = part.duration_s; left_s > 1e-9 && !outcome_.told;
           left_s -= study::kManoeuvreStepS) {
        log_.drive(Eigen::Map<const Eigen::Vector3d>(part.speeds.data()), study::kManoeuvreStepS);
        if (driven_s() >= next_check_s_ - 1e-9) {
          check();
        }
      }
    }
  }

  // Whether kelpie identify tells all by now.
  void check() {
    next_check_s_ = driven_s() + kCheckS;
    PlanarFit fit;
    try {
      fit = scaled_by_thrust(fit_planar(log_.rows()), known_);
    } catch (const InputError&) {
      return;  // too little excitation so far
    }
    double worst = 0.0;
    double squares = 0.0;
    const std::vector<std::size_t> places = study::wanted_places(fit, plan_.tell);
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
    const PlanarFit fit = scaled_by_thrust(fit_planar(log_.rows()), known_);
    const std::vector<std::size_t> places = study::wanted_places(fit, plan_.tell);
    std::vector<double> ratios;
    for (std::size_t i = 0; i < places.size(); ++i) {
      ratios.push_back(leg.countdown.back().numbers[i] / study::interval_share(fit, places[i]));
    }
    outcome_.expected = quantile(ratios, 0.5);
  }

  const DriveStudyPlan& plan_;
  Driver driver_;
  FreeDriver free_;
  LoggedDrive log_;
  std::vector<double> truth_;
  std::vector<std::pair<std::string, double>> known_;
  study::ThrusterRange range_;
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
  std::atomic<bool> stopped{false};
  std::mutex mutex;
  std::size_t done = 0;
  const std::size_t all = plan.seeds * kDrivers.size();
  jobs::run_all(all, plan.threads, [&](std::size_t job) {
    if (stopped) {
      return;
    }
    const std::size_t seed = job / kDrivers.size();
    const std::size_t which = job % kDrivers.size();
    study.seeds[seed][which] = StudiedDrive(plan, kDrivers[which], plan.scenario.seed + seed).run();
    const std::lock_guard lock(mutex);
    if (!plan.keep_going(static_cast<double>(++done) / static_cast<double>(all))) {
      stopped = true;
    }
  });
  study.interrupted = stopped;
  return study;
}

}  // namespace kelpie::lab
