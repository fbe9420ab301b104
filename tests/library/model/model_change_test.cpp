// SPDX-License-Identifier: Apache-2.0
// What a whole model makes of a change of its vehicle.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "kelpie/model/dynamics_model.hpp"
#include "model/planar_drive.hpp"

namespace kelpie::model_change_test {
namespace {

using testing::PlanarDrive;

constexpr double kStep = 0.2;  // s
constexpr std::size_t kBefore = 5'000;

ModelSettings settings(const std::string& adapt = "follow") {
  ModelSettings settings = ModelSettings::from_preset("small", 2);
  settings.assign("buffer", "200");
  settings.assign("adapt", adapt);
  return settings;
}

PlanarDrive drive_and_lose_half_a_thruster(std::size_t after, std::size_t again = 0) {
  PlanarDrive drive;
  drive.drive(1, kBefore, kStep);
  drive.drive(2, after, kStep, 0.5);
  drive.drive(3, again, kStep);
  RandomStream noise(4, "noise");
  for (std::array<double, 2>& y : drive.y) {
    for (double& value : y) {
      value += 0.02 * noise.normal();
    }
  }
  return drive;
}

DynamicsModel learn(const PlanarDrive& drive, const ModelSettings& with) {
  DynamicsModel model(drive.inputs, drive.targets, with);
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    model.update(drive.x[i], drive.y[i], drive.t[i]);
  }
  return model;
}

// R² of an axis on a drive with other commands, of the damaged vehicle if not told otherwise.
double r_squared(const DynamicsModel& model, std::size_t axis, double strength = 0.5) {
  PlanarDrive other;
  other.drive(9, 2'000, kStep, strength);
  double mean = 0.0;
  for (const auto& y : other.y) {
    mean += y[axis] / static_cast<double>(other.y.size());
  }
  double error = 0.0;
  double spread = 0.0;
  std::vector<double> said(2);
  for (std::size_t i = 0; i < other.x.size(); ++i) {
    model.predict(other.x[i], said);
    error += std::pow(other.y[i][axis] - said[axis], 2);
    spread += std::pow(other.y[i][axis] - mean, 2);
  }
  return 1.0 - error / spread;
}

TEST(ModelChange, KnowsTheDamagedVehicleAfterAHundredRows) {
  const PlanarDrive drive = drive_and_lose_half_a_thruster(100);
  const DynamicsModel adaptive = learn(drive, settings());
  const DynamicsModel rigid = learn(drive, settings("none"));
  for (std::size_t axis = 0; axis < 2; ++axis) {
    EXPECT_GT(r_squared(adaptive, axis), 0.8) << axis;
    EXPECT_GT(r_squared(adaptive, axis), r_squared(rigid, axis) + 0.1) << axis;
    EXPECT_EQ(adaptive.axis(axis).status().tally.changes, 1) << axis;
    EXPECT_EQ(rigid.axis(axis).status().tally.changes, 0) << axis;
  }
}

// What was learned of the whole vehicle holds for the commands times their factors, there and back.
TEST(ModelChange, NothingLearnedIsLostWhereAThrusterFailsAndIsRepaired) {
  const DynamicsModel failed = learn(drive_and_lose_half_a_thruster(300), settings());
  const DynamicsModel repaired = learn(drive_and_lose_half_a_thruster(1'000, 400), settings());
  for (std::size_t axis = 0; axis < 2; ++axis) {
    EXPECT_GT(r_squared(failed, axis), 0.97) << axis;
    EXPECT_GT(r_squared(repaired, axis, 1.0), 0.97) << axis;
    EXPECT_EQ(repaired.axis(axis).status().tally.changes, 2) << axis;
  }
}

TEST(ModelChange, IsReportedOnceByTheLogsClock) {
  const PlanarDrive drive = drive_and_lose_half_a_thruster(300);
  constexpr double kClockSet = 10.0;  // s, back, in the middle of the first part
  DynamicsModel model(drive.inputs, drive.targets, settings());
  std::vector<double> since;
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    model.update(drive.x[i], drive.y[i], drive.t[i] - (i > kBefore / 2 ? kClockSet : 0.0));
    if (model.decisions()[0].changed) {
      since.push_back(model.decisions()[0].changed_since);
      EXPECT_TRUE(model.decisions()[1].changed);
    }
  }
  ASSERT_EQ(since.size(), 1U);
  EXPECT_NEAR(since[0], static_cast<double>(kBefore) * kStep - kClockSet, 15.0);
}

TEST(ModelChange, IsWithdrawnWhereTheVehicleIsAsBefore) {
  ModelSettings forgetful = settings();
  forgetful.assign("memory", "0");  // a vehicle kept would be known again, which is sooner
  const DynamicsModel model = learn(drive_and_lose_half_a_thruster(200, 300), forgetful);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    EXPECT_EQ(model.axis(axis).status().tally.changes, 1) << axis;
    EXPECT_EQ(model.axis(axis).status().tally.withdrawn, 1) << axis;
  }
}

// The sensor's offset is not the vehicle's: nothing that was learned is wrong. A drive in six shows
// an offset as a change of effects.
std::int64_t changes_of_an_offset(std::uint64_t seeds) {
  std::int64_t believed = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    PlanarDrive drive;
    drive.drive(seed, 2'400, kStep);
    RandomStream noise(seed, "noise");
    for (std::size_t i = 0; i < drive.y.size(); ++i) {
      for (double& value : drive.y[i]) {
        value += (i < 1'200 ? 0.0 : 0.2) + 0.02 * noise.normal();
      }
    }
    const DynamicsModel model = learn(drive, ModelSettings::from_preset("default", 2));
    const std::int64_t changes = model.axis(0).status().tally.changes;
    EXPECT_EQ(model.axis(1).status().tally.changes, changes) << seed;
    EXPECT_GT(r_squared(model, 1, 1.0), 0.3) << seed;
    believed += changes;
  }
  return believed;
}

TEST(ModelChange, AnOffsetOfTheSensorIsNoChange) {
  EXPECT_EQ(changes_of_an_offset(1), 0);
}

TEST(MeasuredModelChange, FourOffsetsOfFiveAreNoChange) {
  EXPECT_LE(changes_of_an_offset(5), 1);
}

TEST(ModelChange, ContinuesFromASavedStateInTheMiddleOfAChange) {
  const PlanarDrive drive = drive_and_lose_half_a_thruster(300);
  DynamicsModel whole(drive.inputs, drive.targets, settings());
  DynamicsModel stopped(drive.inputs, drive.targets, settings());
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    if (i > kBefore && i % 40 == 0) {
      stopped = DynamicsModel::resume(DynamicsModel(drive.inputs, drive.targets, settings()),
                                      stopped.save());
    }
    whole.update(drive.x[i], drive.y[i], drive.t[i]);
    stopped.update(drive.x[i], drive.y[i], drive.t[i]);
  }
  EXPECT_EQ(whole.save(), stopped.save());
  EXPECT_EQ(whole.axis(0).status().tally.changes, 1);
}

}  // namespace
}  // namespace kelpie::model_change_test
