// SPDX-License-Identifier: Apache-2.0
// A model that goes on where a trained one stands.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "kelpie/core/error.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/model/trained_model.hpp"
#include "model/snapshot.hpp"
#include "support.hpp"
#include "vehicle_stream.hpp"

namespace kelpie::resume_from_test {
namespace {

using testing::Drive;
using testing::message_of;

constexpr double kStep = 0.1;  // seconds

ModelSettings settings_of(const std::string& learner) {
  ModelSettings settings = ModelSettings::from_preset("default", 2);
  settings.assign("learner", learner);
  settings.assign("buffer", "300");
  return settings;
}

DynamicsModel learned(const Drive& drive, const ModelSettings& settings) {
  DynamicsModel model(drive.inputs, drive.targets, settings);
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    model.update(drive.x[i], drive.y[i], kStep * static_cast<double>(i));
  }
  return model;
}

// Standard deviation of the difference between two models, in that of the target.
template <typename Model>
double difference(const TrainedModel& before, const Model& after, const Drive& drive,
                  std::size_t axis) {
  double sum = 0.0;
  std::array<double, 2> a{};
  std::array<double, 2> b{};
  for (const auto& x : drive.x) {
    before.predict(x, a);
    after.predict(x, b);
    sum += std::pow((a[axis] - b[axis]) / before.axes[axis].scaling.target.scale, 2);
  }
  return std::sqrt(sum / static_cast<double>(drive.x.size()));
}

TEST(GoOnWith, ALearnerAloneSaysTheSameToTheSolversTolerance) {
  const Drive drive = testing::drive(1, 900);
  const TrainedModel before = learned(drive, settings_of("svr")).trained();
  const DynamicsModel after = DynamicsModel::resume_from(before);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    EXPECT_LT(difference(before, after, drive, axis), 2e-3) << "axis " << axis;
    EXPECT_GT(after.axis(axis).status().support_vectors, 5);
  }
}

TEST(GoOnWith, TheFirstSamplesOfAnotherLogDoNoHarm) {
  const TrainedModel before = learned(testing::drive(1, 900), settings_of("svr")).trained();
  const Drive next = testing::drive(2, 200);
  DynamicsModel after = DynamicsModel::resume_from(before, 1000.0);
  std::array<double, 2> error{};
  std::array<double, 2> fixed{};
  std::array<double, 2> y{};
  for (std::size_t i = 0; i < next.x.size(); ++i) {
    before.predict(next.x[i], y);
    after.update(next.x[i], next.y[i], 1000.0 + kStep * static_cast<double>(i));
    for (std::size_t axis = 0; axis < 2; ++axis) {
      EXPECT_TRUE(after.decisions()[axis].had_model);
      fixed[axis] += std::abs(next.y[i][axis] - y[axis]);
      error[axis] += std::abs(next.y[i][axis] - after.decisions()[axis].prediction.value);
    }
  }
  for (std::size_t axis = 0; axis < 2; ++axis) {
    EXPECT_LE(error[axis], 1.05 * fixed[axis]) << "axis " << axis;
  }
}

TEST(GoOnWith, SettingsWithOtherTermsAreRefused) {
  TrainedModel before = learned(testing::drive(1, 400), settings_of("svr")).trained();
  before.settings.assign("terms", "none");
  EXPECT_EQ(
      message_of<InputError>([&] { DynamicsModel::resume_from(before); }),
      "terms: give 0 physics terms; the trained model has " + std::to_string(before.terms.size()));
}

TEST(GoOnWith, AStampThatGoesBackStopsTheClockOnly) {
  const Drive drive = testing::drive(1, 600);
  const ModelSettings settings = settings_of("svr");
  DynamicsModel steady(drive.inputs, drive.targets, settings);
  DynamicsModel stepping(drive.inputs, drive.targets, settings);
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    const double t = kStep * static_cast<double>(i);
    const double late = i < 300 ? t : t + kStep - 1e6;  // the first sample after it has no step
    steady.update(drive.x[i], drive.y[i], i < 300 ? t : t - kStep);
    stepping.update(drive.x[i], drive.y[i], late);
  }
  std::array<double, 2> a{};
  std::array<double, 2> b{};
  for (const auto& x : drive.x) {
    steady.predict(x, a);
    stepping.predict(x, b);
    EXPECT_NEAR(a[0], b[0], 1e-9);
    EXPECT_NEAR(a[1], b[1], 1e-9);
  }
}

}  // namespace
}  // namespace kelpie::resume_from_test
