// SPDX-License-Identifier: Apache-2.0
// A model saved and resumed goes on to the last bit as the one that never stopped.
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/model/trained_model.hpp"
#include "model/model_axis.hpp"
#include "model/snapshot.hpp"
#include "support.hpp"

namespace kelpie::resume_test {
namespace {

using testing::message_of;

const std::vector<std::string> kInputs{"u", "v", "n1", "n2"};
const std::vector<std::string> kTargets{"udot", "vdot"};

struct Log {
  std::vector<std::array<double, 4>> x;
  std::vector<std::array<double, 2>> y;
};

// A vehicle with two velocities and two thrusters, which begins with little motion (so that the
// scale is taken anew) and has its thrusters the other way round in its second half.
Log drive(std::size_t samples) {
  RandomStream random(5, "drive");
  Log log;
  double u = 0.0;
  double v = 0.0;
  double phase = 0.0;
  double slow = 1.0;
  for (std::size_t i = 0; i < samples; ++i) {
    phase += random.uniform(0.02, 0.1);
    slow += random.uniform(0.01, 0.07);
    const double size = i < 100 ? 1.0 : 10.0;
    const double n1 = size * std::sin(phase);
    const double n2 = size * std::cos(slow);
    const double gain = 2 * i < samples ? 1.0 : -1.0;
    const double udot = gain * 0.02 * n1 * std::abs(n1) - 2.0 * u * std::abs(u) - u;
    const double vdot = gain * 0.01 * n2 * std::abs(n2) - 3.0 * v * std::abs(v) - v;
    log.x.push_back({u, v, n1, n2});
    log.y.push_back({udot + 0.01 * random.normal(), vdot + 0.01 * random.normal()});
    u += 0.1 * udot;
    v += 0.1 * vdot;
  }
  return log;
}

ModelSettings small(const std::string& preset) {
  ModelSettings settings = ModelSettings::from_preset(preset, 2);
  settings.assign("buffer", "120");
  settings.assign("anchors", "30");
  settings.assign("warmup", "50");
  return settings;
}

DynamicsModel make(const ModelSettings& settings) {
  return {kInputs, kTargets, settings};
}

// Put away and taken up again at random moments, the first of them during the warm-up.
Tally expect_same_life(const ModelSettings& settings, std::size_t samples) {
  const Log log = drive(samples);
  RandomStream random(9, "stops");
  DynamicsModel whole = make(settings);
  DynamicsModel broken = make(settings);
  std::array<double, 2> a{};
  std::array<double, 2> b{};
  for (std::size_t i = 0; i < samples && !::testing::Test::HasFailure(); ++i) {
    if (random.below(20) == 0) {
      const std::string state = broken.save();
      EXPECT_EQ(state, whole.save()) << "sample " << i;
      broken = DynamicsModel::resume(make(settings), state);
    }
    const double t = 0.1 * static_cast<double>(i);
    whole.update(log.x[i], log.y[i], t);
    broken.update(log.x[i], log.y[i], t);
    whole.predict(log.x[(7 * i) % samples], a);
    broken.predict(log.x[(7 * i) % samples], b);
    EXPECT_EQ(a, b) << "sample " << i;
  }
  EXPECT_TRUE(whole.ready());
  EXPECT_TRUE(whole.trained().axes[0].steady.ready());
  EXPECT_EQ(whole.save(), broken.save());
  return whole.axis(0).status().tally;
}

TEST(ResumeModel, TheDefaultPresetGoesOnToTheLastBit) {
  EXPECT_GT(expect_same_life(small("default"), 1500).changes, 0);
}

TEST(ResumeModel, ThePapersPresetGoesOnToTheLastBit) {
  EXPECT_GT(expect_same_life(small("paper"), 800).forgotten, 0);
}

TEST(ResumeModel, ALearnerAloneGoesOnToTheLastBit) {
  ModelSettings settings = small("default");
  settings.assign("learner", "svr");
  settings.assign("warmup", "200");
  settings.assign("storage", "float");
  settings.assign("scaling", "full");
  expect_same_life(settings, 1500);
}

TEST(ResumeModel, CanBeSavedAtEveryUpdateOfTheWayToAnotherScale) {
  const Log log = drive(500);
  DynamicsModel whole = make(small("default"));
  DynamicsModel broken = make(small("default"));
  std::array<double, 2> a{};
  std::array<double, 2> b{};
  double scale = 0.0;
  std::size_t scales = 0;
  for (std::size_t i = 0; i < 500; ++i) {
    if (i >= 45 && i < 300) {
      broken = DynamicsModel::resume(make(small("default")), broken.save());
    }
    const double t = 0.1 * static_cast<double>(i);
    whole.update(log.x[i], log.y[i], t);
    broken.update(log.x[i], log.y[i], t);
    whole.predict(log.x[(7 * i) % 500], a);
    broken.predict(log.x[(7 * i) % 500], b);
    ASSERT_EQ(a, b) << "sample " << i;
    const AxisScaling* const scaling = whole.mechanisms(0).scaling();
    const double now = scaling == nullptr ? 0.0 : scaling->target.scale;
    scales += i < 300 && now != scale ? 1 : 0;
    scale = now;
  }
  EXPECT_GT(scales, 2U);
  EXPECT_EQ(whole.save(), broken.save());
}

TEST(ResumeModel, AGivenScalingStaysTheOneThatWasGiven) {
  const Log log = drive(300);
  ModelSettings settings = small("default");
  settings.assign("learner", "svr");
  DynamicsModel model = make(settings);
  for (std::size_t i = 0; i < 300; ++i) {
    model.update(log.x[i], log.y[i], 0.1 * static_cast<double>(i));
  }
  const std::array scaling{*model.mechanisms(0).scaling(), *model.mechanisms(1).scaling()};
  DynamicsModel given(kInputs, kTargets, settings, scaling);
  given.update(log.x[0], log.y[0], 0.0);
  const std::string state = given.save();
  const DynamicsModel resumed =
      DynamicsModel::resume({kInputs, kTargets, settings, scaling}, state);
  EXPECT_EQ(resumed.save(), state);
  EXPECT_EQ(message_of<InputError>([&] { DynamicsModel::resume(make(settings), state); }),
            "scales: is 'given' in what was saved, 'from the first samples' here");
}

TEST(ResumeModel, WhatDiffersIsNamed) {
  const std::string state = make(small("default")).save();
  const auto refusal = [&](const std::string& field, const std::string& value) {
    ModelSettings other = small("default");
    other.assign(field, value);
    return message_of<InputError>([&] { DynamicsModel::resume(make(other), state); });
  };
  EXPECT_EQ(refusal("gamma", "0.3"), "gamma: is '0.1' in what was saved, '0.3' here");
  EXPECT_EQ(refusal("terms", "none"), "terms: is 'auto' in what was saved, 'none' here");
  EXPECT_EQ(refusal("buffer", "121"), "buffer: is '120' in what was saved, '121' here");
  const auto with_names = [&](std::vector<std::string> inputs, std::vector<std::string> targets) {
    return message_of<InputError>([&] {
      DynamicsModel::resume({std::move(inputs), std::move(targets), small("default")}, state);
    });
  };
  EXPECT_EQ(with_names({"u", "v", "n2", "n1"}, kTargets),
            "inputs: is 'u, v, n1, n2' in what was saved, 'u, v, n2, n1' here");
  EXPECT_EQ(with_names(kInputs, {"udot", "wdot"}),
            "targets: is 'udot, vdot' in what was saved, 'udot, wdot' here");
}

TEST(ResumeModel, EveryTruncationIsRefused) {
  ModelSettings settings = small("default");
  settings.assign("buffer", "5");
  const Log log = drive(70);
  DynamicsModel model = make(settings);
  for (std::size_t i = 0; i < 70; ++i) {
    model.update(log.x[i], log.y[i], 0.1 * static_cast<double>(i));
  }
  const std::string state = model.save();
  for (std::size_t size = 0; size < state.size(); size += 61) {
    EXPECT_THROW(DynamicsModel::resume(make(settings), state.substr(0, size)), InputError) << size;
  }
}

}  // namespace
}  // namespace kelpie::resume_test
