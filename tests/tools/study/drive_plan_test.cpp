// SPDX-License-Identifier: Apache-2.0
#include "study/drive_plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "motion/weak_form.hpp"

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

 private:
  RandomStream random_;
  PlanarVector velocity_{};
  PlanarRows rows_;
  double fastest_ = 0.0;
};

const ThrusterRange kRange{{-12.0, -12.0, -12.0}, {12.0, 12.0, 12.0}};

DrivePlan plan_for(const ExpectedPlanarFit& expected, const DriveBounds& bounds) {
  const DriveGoal goal =
      telling_goal(expected, wanted_places(expected.now(), {}), 0.05, [](PlanarFit&) {});
  return plan_drive(expected.now(), PlanarPush(expected.now().vehicle(), kRange), bounds, goal,
                    kRowS);
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

// The true vehicle keeps the speed, whatever the noise.
TEST(DrivePlan, KeepsTheBounds) {
  for (std::uint64_t seed = 11; seed < 14; ++seed) {
    NoisyDrive drive(seed);
    drive.wander(90.0);
    const ExpectedPlanarFit expected(drive.rows());
    const DriveBounds bounds{.time_s = 30.0, .speed_m_s = 0.5, .radius_m = 5.0};
    const DrivePlan plan = plan_for(expected, bounds);
    EXPECT_LE(plan.duration_s(), bounds.time_s);
    EXPECT_LE(plan.farthest_m, bounds.radius_m);
    NoisyDrive again(seed);
    for (const Manoeuvre& manoeuvre : plan.manoeuvres) {
      for (const HeldSpeeds& part : manoeuvre.parts) {
        again.hold(part.speeds, part.duration_s);
      }
    }
    EXPECT_LE(again.fastest(), bounds.speed_m_s) << seed;
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

// A change and nearly the same change are hard to tell apart; a larger change is told sooner.
TEST(DrivePlan, EvidenceGrowsWithTheSquareOfTheChange) {
  NoisyDrive drive(1);
  drive.wander(120.0);
  const ExpectedPlanarFit expected(drive.rows());
  NoisyDrive next(2);
  next.wander(60.0);
  const WeakRows windows = weak_rows(next.rows(), {});
  const auto nats = [&](const std::string& a, const std::string& b, double share) {
    return parting_goal(expected, a, b, share).progress(windows).numbers.front();
  };
  const double small = nats("th2", "drag", 0.1);
  EXPECT_GT(small, 0.0);
  EXPECT_NEAR(nats("th2", "drag", 0.2) / small, 4.0, 0.8);
  EXPECT_NEAR(nats("th2", "drag", 0.1), nats("drag", "th2", 0.1), 1e-6 * small);
}

}  // namespace
}  // namespace kelpie::study::drive_plan_test
