// SPDX-License-Identifier: Apache-2.0
#include "study/drive_plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "identify/weak_form.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "simulator/frames.hpp"
#include "simulator/pilot.hpp"
#include "simulator/scenario_file.hpp"
#include "simulator/sensors.hpp"
#include "simulator/simulation.hpp"
#include "simulator/simulator.hpp"
#include "study/six_axes.hpp"
#include "study/tuning.hpp"
#include "support.hpp"

namespace kelpie::study::drive_plan_test {
namespace {

constexpr double kRowS = 0.25;
constexpr double kNoise = 0.002;

PlanarVehicle a_vehicle() {
  return {.surge_inertia = 1.0,
          .sway_inertia = 1.2,
          .sway_yaw_inertia = 0.02,
          .yaw_inertia = 0.1,
          .linear_drag = {0.16, 0.18, 0.015},
          .quadratic_drag = {0.1, 0.7, 0.012},
          .constant_force = {},
          .thrusters = {{"th1", 3e-4, 2.4e-4, 0.0, 0.32},
                        {"th2", 3e-4, 2.4e-4, 0.0, -0.32},
                        {"th3", 4.2e-4, 3.2e-4, 1.57, -0.4}}};
}

/// A drive in the plane with noise of the velocities: exactly the vehicle of the fit.
class NoisyDrive {
 public:
  explicit NoisyDrive(std::uint64_t seed) : random_(seed, "noise") {
    rows_.thrusters = {"th1", "th2", "th3"};
  }

  void hold(const std::vector<double>& speeds, double duration_s) {
    const PlanarVehicle vehicle = a_vehicle();
    for (double left_s = duration_s; left_s > 1e-9; left_s -= kRowS) {
      rows_.times_s.push_back(kRowS * static_cast<double>(rows_.rows()));
      for (const double value : velocity_) {
        rows_.velocities.push_back(value + kNoise * random_.normal());
      }
      rows_.speeds.insert(rows_.speeds.end(), speeds.begin(), speeds.end());
      constexpr int kParts = 25;
      for (int part = 0; part < kParts; ++part) {
        const PlanarVector slope = vehicle.acceleration(velocity_, speeds);
        for (std::size_t axis = 0; axis < kPlanarAxes; ++axis) {
          velocity_[axis] += kRowS / kParts * slope[axis];
        }
        move(kRowS / kParts);
      }
      fastest_ = std::max(fastest_, std::hypot(velocity_[0], velocity_[1]));
    }
  }

  void wander(double duration_s) {
    for (double t = 0.0; t < duration_s; t += 3.0) {
      std::vector<double> speeds;
      for (int i = 0; i < 3; ++i) {
        speeds.push_back(random_.uniform(-12.0, 12.0));
      }
      hold(speeds, 3.0);
    }
  }

  const PlanarRows& rows() const { return rows_; }
  double fastest() const { return fastest_; }
  double farthest() const { return farthest_; }  ///< m, from the start

 private:
  void move(double dt_s) {
    const auto [surge, sway, yaw_rate] = velocity_;
    x_ += dt_s * (surge * std::cos(heading_) - sway * std::sin(heading_));
    y_ += dt_s * (surge * std::sin(heading_) + sway * std::cos(heading_));
    heading_ += dt_s * yaw_rate;
    farthest_ = std::max(farthest_, std::hypot(x_, y_));
  }

  RandomStream random_;
  PlanarVector velocity_{};
  PlanarRows rows_;
  double x_ = 0.0, y_ = 0.0, heading_ = 0.0;
  double fastest_ = 0.0;
  double farthest_ = 0.0;
};

const ThrusterRange kRange{{-12.0, -12.0, -12.0}, {12.0, 12.0, 12.0}};

DrivePlan plan_for(const ExpectedPlanarFit& expected, const DriveBounds& bounds) {
  const DriveGoal goal =
      telling_goal(expected, wanted_places(expected.now(), {}), 0.05, [](ParameterFit&) {});
  return plan_drive(DrivablePlanarVehicle(expected, kRange, kRowS), bounds, goal);
}

// The errors that the plan expects are those that fit_planar() finds after the drive, within a
// factor of 2, and smaller than those of as long a wandering drive.
TEST(DrivePlan, ExpectsTheErrorsOfTheFitAfterTheDrive) {
  double gain = 0.0;
  for (const std::uint64_t seed : {1U, 2U}) {
    NoisyDrive drive(seed);
    drive.wander(90.0);
    const ExpectedPlanarFit expected(drive.rows());
    const DrivePlan plan = plan_for(expected, {.time_s = 60.0, .speed_m_s = 0.8, .radius_m = 15.0});
    NoisyDrive wandering = drive;
    for (const Manoeuvre& manoeuvre : plan.manoeuvres) {
      for (const HeldSpeeds& part : manoeuvre.parts) {
        drive.hold(part.speeds, part.duration_s);
      }
    }
    wandering.wander(plan.duration_s());
    const PlanarFit after = fit_planar(drive.rows());
    const PlanarFit otherwise = fit_planar(wandering.rows());
    std::vector<double> ratios;
    std::vector<double> gains;
    const std::vector<std::size_t> places = wanted_places(after, {});
    ASSERT_EQ(places.size(), plan.names.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
      ratios.push_back(plan.countdown.back().numbers[i] / interval_share(after, places[i]));
      gains.push_back(interval_share(otherwise, places[i]) / interval_share(after, places[i]));
    }
    std::ranges::sort(ratios);
    std::ranges::sort(gains);
    EXPECT_GT(ratios[ratios.size() / 2], 0.5) << seed;
    EXPECT_LT(ratios[ratios.size() / 2], 2.0) << seed;
    gain += gains[gains.size() / 2] / 2.0;
  }
  EXPECT_GT(gain, 1.0);
}

// The true vehicle keeps speed and distance, whatever the noise, coasting included.
TEST(DrivePlan, KeepsTheBounds) {
  for (std::uint64_t seed = 11; seed < 14; ++seed) {
    NoisyDrive drive(seed);
    drive.wander(90.0);
    const ExpectedPlanarFit expected(drive.rows());
    const DriveBounds bounds{.time_s = 30.0, .speed_m_s = 0.5, .radius_m = 5.0};
    const DrivePlan plan = plan_for(expected, bounds);
    EXPECT_LE(plan.duration_s(), bounds.time_s);
    EXPECT_LE(plan.extent.farthest_m, bounds.radius_m);
    NoisyDrive again(seed);
    for (const Manoeuvre& manoeuvre : plan.manoeuvres) {
      for (const HeldSpeeds& part : manoeuvre.parts) {
        again.hold(part.speeds, part.duration_s);
      }
    }
    again.hold({0.0, 0.0, 0.0}, kTuning.plan.coast_s);
    EXPECT_LE(again.fastest(), bounds.speed_m_s) << seed;
    EXPECT_LE(again.farthest(), bounds.radius_m) << seed;
    EXPECT_GT(again.farthest(), 0.2 * plan.extent.farthest_m) << seed;
  }
}

TEST(DrivePlan, NamesAreWordsOfParameters) {
  NoisyDrive drive(1);
  drive.wander(90.0);
  const ExpectedPlanarFit expected(drive.rows());
  const PlanarFit& fit = expected.now();
  EXPECT_EQ(wanted_places(fit, {"sway_drag"}), (std::vector<std::size_t>{5, 8}));
  EXPECT_EQ(wanted_places(fit, {"th2"}), (std::vector<std::size_t>{17, 18, 19, 20}));
  EXPECT_THROW(wanted_places(fit, {"sway_wing"}), InputError);
  EXPECT_THROW(parting_goal(expected, "th1", "th1", 0.2), InputError);
}

/// Two causes after two minutes and a further one of wandering.
class Suspects {
 public:
  Suspects() : expected_(wandered(1, 120.0)), windows_(weak_rows(wandered(2, 60.0), {})) {}

  DriveGoal goal(const std::string& a, const std::string& b, double share) const {
    return parting_goal(expected_, a, b, share);
  }
  double nats(const std::string& a, const std::string& b, double share) const {
    return goal(a, b, share).progress(windows_).numbers.front();
  }

 private:
  static PlanarRows wandered(std::uint64_t seed, double duration_s) {
    NoisyDrive drive(seed);
    drive.wander(duration_s);
    return drive.rows();
  }

  ExpectedPlanarFit expected_;
  WeakRows windows_;
};

// A change and nearly the same change are hard to tell apart; a larger change is told sooner.
TEST(DrivePlan, EvidenceGrowsWithTheSquareOfTheChange) {
  const Suspects suspects;
  const double small = suspects.nats("th2", "drag", 0.1);
  EXPECT_GT(small, 0.0);
  EXPECT_NEAR(suspects.nats("th2", "drag", 0.2) / small, 4.0, 0.8);
  EXPECT_NEAR(suspects.nats("th2", "drag", 0.1), suspects.nats("drag", "th2", 0.1), 1e-6 * small);
}

// A constant force may be 0, and is told apart from what goes with speed or commands.
TEST(DrivePlan, AllThrustersAndForcesAreCauses) {
  const Suspects suspects;
  EXPECT_GT(suspects.nats("all_thrusters", "th1", 0.2), 1.0);
  EXPECT_GT(suspects.nats("all_thrusters", "surge_force", 0.2), 1.0);
  EXPECT_GT(suspects.nats("sway_force", "yaw_moment", 0.2), 1.0);
  EXPECT_EQ(testing::message_of<InputError>([&] { suspects.goal("th1", "force", 0.2); }),
            "--apart: 'force' changes nothing that is known; a cause is a thruster of the log, "
            "all_thrusters, drag, surge_drag, sway_drag, yaw_drag, load or a constant force: "
            "surge_force, sway_force, yaw_moment");
}

simulator::Scenario gentle_heavy() {
  simulator::Scenario scenario =
      simulator::read_scenario(KELPIE_SOURCE_DIR "/scenarios/bluerov2_heavy.toml");
  scenario.excitation.effort << 12, 12, 10, 1, 1, 1;
  scenario.excitation.dither = 0.02;
  return scenario;
}

/// The simulated BlueROV2 Heavy with a DVL's noise: a gentle pilot, then what is planned.
class HeavyDrive {
 public:
  explicit HeavyDrive(std::uint64_t seed)
      : scenario_(gentle_heavy()),
        simulator_(scenario_.vehicle,
                   simulator::make_plant(scenario_.vehicle, scenario_.configurations.front()),
                   Eigen::Vector3d::Zero(), simulator::State{}),
        sensors_(scenario_.noise, seed),
        pilot_(scenario_.vehicle, scenario_.excitation, seed) {}

  void pilot(double duration_s) {
    for (int tick = 0; tick < ticks(duration_s); ++tick) {
      advance(pilot_.advance(simulator_.state(), simulator::kTickS, 1.0));
    }
  }

  void hold(const std::vector<double>& shares, double duration_s) {
    for (int tick = 0; tick < ticks(duration_s); ++tick) {
      advance(Eigen::Map<const Eigen::VectorXd>(shares.data(), 8));
    }
  }

  DriveMotion motion() const {
    const Eigen::Vector3d angles = simulator::euler_angles(simulator_.state().attitude);
    const Eigen::Vector3d& position = simulator_.state().position_m;
    DriveMotion motion{.position_m = {position.x(), position.y(), position.z()},
                       .angles_rad = {angles.x(), angles.y(), angles.z()}};
    std::ranges::copy(simulator_.state().velocity, motion.velocity.begin());
    return motion;
  }

  /// From here on, as far from here.
  DriveExtent extent_of(const DrivePlan& plan) {
    const DriveMotion start = motion();
    DriveExtent extent;
    for (const Manoeuvre& manoeuvre : plan.manoeuvres) {
      for (const HeldSpeeds& part : manoeuvre.parts) {
        for (double left_s = part.duration_s; left_s > 1e-9; left_s -= 0.1) {
          hold(part.speeds, 0.1);
          DriveMotion now = motion();
          for (std::size_t i = 0; i < 3; ++i) {
            now.position_m[i] -= start.position_m[i];
          }
          extent.include(now);
        }
      }
    }
    return extent;
  }

  SixAxisRows rows() const { return six_axis_rows(log_, scenario_.vehicle); }

 private:
  static int ticks(double duration_s) {
    return static_cast<int>(std::lround(duration_s / simulator::kTickS));
  }

  void advance(const simulator::RotorSpeeds& commands) {
    simulator_.advance(commands);
    if (++ticks_ % 5 == 0) {
      const simulator::Vector6 velocity = sensors_.measure(simulator_.state().velocity);
      log_.push_back(
          simulator::six_axis_row(simulator_, scenario_.vehicle.command_unit, velocity, sensors_));
    }
  }

  simulator::Scenario scenario_;
  simulator::Simulator simulator_;
  simulator::SixAxisSensors sensors_;
  simulator::Pilot pilot_;
  std::vector<simulator::SixAxisRow> log_;
  int ticks_ = 0;
};

double number_of(const ParameterFit& fit, const std::string& name) {
  const auto found = std::ranges::find(fit.parameters, name, &FittedParameter::name);
  return interval_share(fit, static_cast<std::size_t>(found - fit.parameters.begin()));
}

/// A pilot's minute, a rest, the plan for heave and pitch, and the drive.
struct HeavyPlan {
  DriveBounds bounds{.time_s = 30.0, .radius_m = 5.0, .depth_m = 1.5, .tilt_rad = 0.4};
  DrivePlan plan;
  DriveExtent extent;
  SixAxisFit before, after;

  HeavyPlan() {
    HeavyDrive drive(1);
    drive.pilot(60.0);
    drive.hold(std::vector(8, 0.0), 8.0);
    const ExpectedSixAxisFit expected(drive.rows());
    before = fit_six_axes(drive.rows());
    const std::size_t thrusters = before.thrusters.size();
    const DrivableSixAxisVehicle vehicle(
        expected, {std::vector(thrusters, -1.0), std::vector(thrusters, 1.0)}, 1.0);
    const DriveGoal goal =
        telling_goal(expected, wanted_places(expected.now(), {"heave_drag", "pitch_inertia"}),
                     0.005, [](ParameterFit&) {});
    DriveMotion start = drive.motion();
    start.position_m = {};
    plan = plan_drive(vehicle, bounds, goal, start);
    extent = drive.extent_of(plan);
    after = fit_six_axes(drive.rows());
  }
};

const HeavyPlan& heavy_plan() {
  static const HeavyPlan plan;
  return plan;
}

TEST(DrivePlan, KeepsDepthAndTilt) {
  const HeavyPlan& heavy = heavy_plan();
  EXPECT_TRUE(heavy.plan.extent.within(heavy.bounds));
  EXPECT_LE(heavy.extent.farthest_m, heavy.bounds.radius_m);
  EXPECT_LE(heavy.extent.fastest_m_s, heavy.bounds.speed_m_s);
  EXPECT_LE(heavy.extent.depth_m, heavy.bounds.depth_m);
  EXPECT_LE(heavy.extent.tilt_rad, heavy.bounds.tilt_rad);
}

TEST(DrivePlan, HeaveAndPitchAreToldByHeaveAndPitch) {
  const HeavyPlan& heavy = heavy_plan();
  EXPECT_EQ(heavy.plan.names, (std::vector<std::string>{"pitch_inertia", "heave_linear_drag",
                                                        "heave_quadratic_drag"}));
  const auto has = [&](const char* axis) {
    return std::ranges::any_of(heavy.plan.manoeuvres, [&](const Manoeuvre& manoeuvre) {
      return manoeuvre.name.find(axis) != std::string::npos ||
             manoeuvre.name.starts_with("all thrusters");
    });
  };
  EXPECT_TRUE(has("heave"));
  EXPECT_TRUE(has("pitch"));
}

TEST(DrivePlan, ExpectsTheErrorsOfSixAxes) {
  const HeavyPlan& heavy = heavy_plan();
  for (std::size_t i = 0; i < heavy.plan.names.size(); ++i) {
    const double ratio =
        heavy.plan.countdown.back().numbers[i] / number_of(heavy.after, heavy.plan.names[i]);
    EXPECT_GT(ratio, 0.5) << heavy.plan.names[i];
    EXPECT_LT(ratio, 2.0) << heavy.plan.names[i];
    EXPECT_LT(number_of(heavy.after, heavy.plan.names[i]),
              number_of(heavy.before, heavy.plan.names[i]));
  }
}

double worst_of(const ParameterFit& fit, const std::vector<std::string>& names) {
  double worst = 0.0;
  for (const std::string& name : names) {
    worst = std::max(worst, number_of(fit, name));
  }
  return worst;
}

TEST(DrivePlan, SecondsOnSixAxesTellMoreThanAPilot) {
  HeavyDrive drive(1);
  drive.pilot(60.0);
  drive.hold(std::vector(8, 0.0), 8.0);
  const ExpectedSixAxisFit expected(drive.rows());
  const DrivableSixAxisVehicle vehicle(expected, {std::vector(8, -1.0), std::vector(8, 1.0)});
  const DriveGoal goal =
      telling_goal(expected, wanted_places(expected.now(), {"quadratic_drag", "heave_linear_drag"}),
                   0.05, [](ParameterFit&) {});
  HeavyDrive piloted = drive;
  const DrivePlan plan = plan_drive(vehicle, {.time_s = 20.0, .speed_m_s = 0.8}, goal);
  drive.extent_of(plan);
  piloted.pilot(plan.duration_s());
  EXPECT_LT(worst_of(fit_six_axes(drive.rows()), plan.names),
            0.5 * worst_of(fit_six_axes(piloted.rows()), plan.names));
}

TEST(DrivePlan, DrawsAreShortAndWithinTheRange) {
  const HeavyPlan& heavy = heavy_plan();
  ASSERT_FALSE(heavy.plan.manoeuvres.empty());
  std::size_t combined = 0;
  for (const Manoeuvre& manoeuvre : heavy.plan.manoeuvres) {
    EXPECT_LE(manoeuvre.duration_s(), kTuning.plan.longest_draw_s) << manoeuvre.name;
    combined += manoeuvre.name.starts_with("all thrusters") ||
                        manoeuvre.name.find(" and ") != std::string::npos
                    ? 1
                    : 0;
    for (const HeldSpeeds& part : manoeuvre.parts) {
      EXPECT_TRUE(std::ranges::all_of(part.speeds, [](double speed) {
        return std::abs(speed) <= 1.0;
      })) << manoeuvre.name;
    }
  }
  EXPECT_GT(combined, 0U);
}

}  // namespace
}  // namespace kelpie::study::drive_plan_test
