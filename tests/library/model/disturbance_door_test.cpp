// SPDX-License-Identifier: Apache-2.0
// The disturbance at the model's door.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "kelpie/model/dynamics_model.hpp"
#include "model/model_axis.hpp"
#include "model/snapshot.hpp"
#include "vehicle_stream.hpp"

namespace kelpie::disturbance_door_test {
namespace {

constexpr double kStepS = 0.1;

// A current that nobody measures: it pushes surge for some seconds this way, then that way.
testing::Drive drive_in_a_current() {
  testing::Drive samples = testing::drive(5, 1500);
  RandomStream random(6, "current");
  double push = 0.0;
  for (auto& y : samples.y) {
    push = 0.95 * push + 0.03 * random.normal();
    y[0] += push;
  }
  return samples;
}

DynamicsModel make(const testing::Drive& samples) {
  ModelSettings settings = ModelSettings::from_preset("default", 2);
  settings.assign("warmup", "100");
  settings.assign("gamma", "0.5");
  return {samples.inputs, samples.targets, settings};
}

TEST(DisturbanceAtTheDoor, WhatTheModelMissesIsOfferedBesideIt) {
  const testing::Drive samples = drive_in_a_current();
  DynamicsModel model = make(samples);
  std::array<Prediction, 2> said{};
  std::array<double, 2> value{};
  double alone = 0.0;
  double corrected = 0.0;
  double width = 0.0;
  double corrected_width = 0.0;
  int held = 0;
  for (std::size_t i = 0; i < samples.x.size(); ++i) {
    model.predict(samples.x[i], said);
    model.predict(samples.x[i], value);
    EXPECT_EQ(said[0].value, value[0]);  // the model stays what it is
    model.update(samples.x[i], samples.y[i], kStepS * static_cast<double>(i));
    const Decision& decision = model.decisions()[0];
    if (i >= 500) {
      const double y = samples.y[i][0];
      // What was said beforehand is what the decision tells.
      EXPECT_NEAR(decision.prediction.disturbance, said[0].disturbance, 1e-9);
      EXPECT_NEAR(decision.prediction.corrected_lower, said[0].corrected_lower, 1e-9);
      EXPECT_NEAR(decision.prediction.corrected_upper, said[0].corrected_upper, 1e-9);
      width += decision.prediction.upper - decision.prediction.lower;
      corrected_width += decision.prediction.corrected_upper - decision.prediction.corrected_lower;
      alone += std::pow(y - decision.prediction.value, 2);
      corrected += std::pow(y - decision.prediction.value - decision.prediction.disturbance, 2);
      held += decision.prediction.corrected_lower <= y && y <= decision.prediction.corrected_upper
                  ? 1
                  : 0;
    }
  }
  EXPECT_LT(corrected / 1000.0, 2.0 * 0.03 * 0.03);
  EXPECT_LT(corrected_width, 0.9 * width);
  EXPECT_LT(corrected, 0.6 * alone);
  EXPECT_NEAR(held / 1000.0, 0.9, 0.03);  // three standard errors of fair tosses
}

TEST(DisturbanceAtTheDoor, TheDisturbanceFadesWithTime) {
  const testing::Drive samples = drive_in_a_current();
  DynamicsModel model = make(samples);
  for (std::size_t i = 0; i < samples.x.size(); ++i) {
    model.update(samples.x[i], samples.y[i], kStepS * static_cast<double>(i));
  }
  const Disturbance disturbance = model.mechanisms(0).snapshot().disturbance.value();
  const double soon = disturbance.ahead(0.0, 2.0 * kStepS);
  EXPECT_GT(disturbance.autocorrelation(), 0.5);
  EXPECT_NEAR(disturbance.ahead(0.0, 4.0 * kStepS) / soon,
              std::pow(disturbance.autocorrelation(), 2.0), 0.05);
  EXPECT_NEAR(disturbance.ahead(0.0, 1e4), 0.0, 1e-12);
}

TEST(DisturbanceAtTheDoor, WithoutAModelThereIsNoDisturbance) {
  const testing::Drive samples = drive_in_a_current();
  DynamicsModel model = make(samples);
  std::array<Prediction, 2> said{};
  for (std::size_t i = 0; i < 9; ++i) {
    model.update(samples.x[i], samples.y[i], kStepS * static_cast<double>(i));
    model.predict(samples.x[i], said);
    EXPECT_EQ(model.decisions()[0].prediction.disturbance, 0.0);
    EXPECT_EQ(said[0].disturbance, 0.0);
    EXPECT_TRUE(std::isinf(said[0].corrected_upper));
  }
}

}  // namespace
}  // namespace kelpie::disturbance_door_test
