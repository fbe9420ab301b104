// SPDX-License-Identifier: Apache-2.0
// What a whole model says of its vehicle.
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/vehicle/diagnosis.hpp"
#include "model/planar_drive.hpp"

namespace kelpie::model_diagnosis_test {
namespace {

ModelSettings quick(std::size_t axes) {
  ModelSettings settings = ModelSettings::from_preset("small", axes);
  settings.assign("learner", "svr");
  settings.assign("buffer", "100");
  return settings;
}

// Expects that a model, shown the drive with noise at the times `clock(t)`, names n1 at half of its
// thrust, since `since_s`.
void expect_weak_thruster(testing::PlanarDrive& drive, const std::function<double(double)>& clock,
                          double since_s) {
  DynamicsModel model(drive.inputs, drive.targets, quick(2));
  RandomStream noise(3, "noise");
  for (std::size_t row = 0; row < drive.x.size(); ++row) {
    for (double& value : drive.y[row]) {
      value += 1e-3 * noise.normal();
    }
    model.update(drive.x[row], drive.y[row], clock(drive.t[row]));
  }
  const std::vector<Finding> findings = model.findings();
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_NEAR(findings[0].since_s, since_s, 8.0);
  const std::string text = finding_text(findings[0], {drive.inputs, drive.targets});
  EXPECT_EQ(text.substr(0, 12), "n1 gives 50.") << text;
}

TEST(ModelDiagnosis, NamesTheThrusterByTheLogsClock) {
  testing::PlanarDrive drive;
  drive.drive(1, 2000, 0.25);
  drive.drive(2, 240, 0.25, 0.5);
  constexpr double kTaken = 250.0;    // s: the reference has been taken
  constexpr double kClockSet = 10.0;  // s, back
  expect_weak_thruster(
      drive, [](double t) { return t > kTaken ? t - kClockSet : t; }, 500.0 - kClockSet);
}

// A quarter of an hour of a healthy vehicle with a pause, at any rate: one row per second as in the
// paper, too.
TEST(ModelDiagnosis, NamesTheThrusterAtSlowAndFastRates) {
  constexpr double kPauseAfter = 840.0;  // s
  constexpr double kPause = 3600.0;      // s without rows, which forgets nothing
  for (const double step_s : {1.0, 0.5, 0.05}) {
    SCOPED_TRACE(step_s);
    testing::PlanarDrive drive;
    drive.drive(1, static_cast<std::size_t>(900.0 / step_s), step_s);
    drive.drive(2, static_cast<std::size_t>(60.0 / step_s), step_s, 0.5);
    expect_weak_thruster(
        drive, [](double t) { return t > kPauseAfter ? t + kPause : t; }, 900.0 + kPause);
  }
}

// x|x| of such a row has no square: the row is invalid for the axes and for the diagnosis.
TEST(ModelDiagnosis, AnAbsurdRowLeavesAStateThatLoads) {
  const auto make = [] { return DynamicsModel({"u", "r", "n1", "n2"}, {"du", "dr"}, quick(2)); };
  DynamicsModel model = make();
  RandomStream random(5, "absurd");
  for (int i = 0; i < 300; ++i) {
    std::vector<double> x;
    for (int k = 0; k < 4; ++k) {
      x.push_back(i % 100 == 50 ? 1e100 : random.normal());
    }
    model.update(x, std::vector{random.normal(), random.normal()}, 0.25 * i);
  }
  EXPECT_NO_THROW(DynamicsModel::resume(make(), model.save()));
}

TEST(ModelDiagnosis, IsNoneWhereNobodyKnowsWhatAVelocityIs) {
  const DynamicsModel model({"a", "b", "c"}, {"d"}, quick(1));
  EXPECT_EQ(model.diagnosis(), nullptr);
  EXPECT_TRUE(model.findings().empty());
}

}  // namespace
}  // namespace kelpie::model_diagnosis_test
