// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/open_loop.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "kelpie/core/error.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/model/rollout.hpp"
#include "kelpie/model/trained_model.hpp"
#include "kelpie/motion/term_set.hpp"
#include "kelpie/vehicle/diagnosis.hpp"
#include "model/planar_drive.hpp"
#include "model/snapshot.hpp"
#include "model/steady_part.hpp"
#include "support.hpp"

namespace kelpie::open_loop_test {
namespace {

using testing::message_of;
using testing::PlanarDrive;

TrainedModel learned(const PlanarDrive& drive, const char* states) {
  ModelSettings settings = ModelSettings::from_preset("default", 2);
  settings.assign("states", states);
  settings.assign("buffer", "200");
  DynamicsModel model(drive.inputs, drive.targets, settings);
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    model.update(drive.x[i], drive.y[i], drive.t[i]);
  }
  return model.trained();
}

class OpenLoopModel : public ::testing::Test {
 protected:
  OpenLoopModel() { drive_.drive(1, 1500, 0.1); }

  PlanarDrive drive_;
};

TEST_F(OpenLoopModel, MixesTheLearnedModelAndItsEquationsByTheirShares) {
  TrainedModel model = learned(drive_, "auto");
  model.axes[0].steady.share = 0.25;
  const OpenLoop both = open_loop(model);
  const OpenLoop alone = open_loop(model, OpenLoopPart::learned);
  const OpenLoop equations = open_loop(model, OpenLoopPart::steady);
  EXPECT_EQ(both.states, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(both.axes, (std::vector<std::optional<std::size_t>>{0, 5}));  // u and r
  for (std::size_t i = 0; i < drive_.x.size(); i += 100) {
    std::array<double, 2> full{};
    std::array<double, 2> f{};
    std::array<double, 2> w{};
    std::array<double, 2> a{};
    model.predict(drive_.x[i], full);
    alone.accelerations(drive_.x[i], f);
    equations.accelerations(drive_.x[i], w);
    both.accelerations(drive_.x[i], a);
    EXPECT_EQ(f, full);
    EXPECT_NEAR(a[0], 0.25 * w[0] + 0.75 * f[0], 1e-12);
    EXPECT_NEAR(w[1], drive_.y[i][1], 0.02);
  }
}

TEST_F(OpenLoopModel, FollowsAnUnseenDriveForMinutes) {
  PlanarDrive other;
  other.drive(2, 600, 0.1);
  Rollout rollout(open_loop(learned(drive_, "auto")));
  rollout.start(other.x[0]);
  double worst = 0.0;
  for (std::size_t i = 1; i < other.x.size(); ++i) {
    rollout.advance(other.x[i], 0.1);
    worst = std::max(worst, std::abs(rollout.velocity(0) - other.x[i][0]));
  }
  EXPECT_LT(worst, 0.05);  // of ±0.9
}

TEST_F(OpenLoopModel, SurvivesStatesInAnyPlace) {
  PlanarDrive turned = drive_;
  turned.inputs = {"n1", "speed", "n2", "turn"};
  for (std::array<double, 4>& x : turned.x) {
    x = {x[2], x[0], x[3], x[1]};
  }
  const TrainedModel model = learned(turned, "speed,turn");
  const OpenLoop loop = open_loop(model);
  EXPECT_EQ(loop.states, (std::vector<std::size_t>{1, 3}));
  Rollout rollout(loop);
  rollout.start(turned.x[1000]);
  for (std::size_t i = 1001; i < 1200; ++i) {
    rollout.advance(turned.x[i], 0.1);
  }
  EXPECT_NEAR(rollout.velocity(0), turned.x[1199][1], 0.03);
}

// How far a rollout of the last 30 s of a drive is off in surge, root mean square.
double error_of_last(const TrainedModel& model, const PlanarDrive& drive, double step_s) {
  const auto rows = static_cast<std::size_t>(30.0 / step_s);
  const std::size_t begin = drive.x.size() - rows;
  Rollout rollout(open_loop(model));
  rollout.start(drive.x[begin]);
  double sum = 0.0;
  for (std::size_t i = begin + 1; i < drive.x.size(); ++i) {
    rollout.advance(drive.x[i], step_s);
    const double error = rollout.velocity(0) - drive.x[i][0];
    sum += error * error;
  }
  return std::sqrt(sum / static_cast<double>(rows));
}

TEST(OpenLoop, IsThereOnceAndForAllAlsoWhileAChangeIsLearned) {
  constexpr double kStep = 0.25;
  constexpr std::size_t kBefore = 1200;
  PlanarDrive drive;
  drive.drive(1, kBefore, kStep);
  drive.drive(2, 600, kStep, -0.5);  // a propeller put on the wrong way round
  ModelSettings settings = ModelSettings::from_preset("small", 2);
  settings.assign("buffer", "300");
  DynamicsModel model(drive.inputs, drive.targets, settings);
  RandomStream noise(3, "noise");
  bool changed = false;
  TrainedModel before;
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    const std::array<double, 2> y{drive.y[i][0] + 1e-3 * noise.normal(),
                                  drive.y[i][1] + 1e-3 * noise.normal()};
    model.update(drive.x[i], y, drive.t[i]);
    if (i + 1 == kBefore) {
      before = model.trained();
    }
    changed = changed || (i >= kBefore && model.decisions()[0].changed);
    if (changed && i % 20 == 0) {
      ASSERT_NO_THROW(open_loop(model.trained())) << i;
    }
  }
  ASSERT_TRUE(changed);
  EXPECT_LT(error_of_last(model.trained(), drive, kStep),
            0.3 * error_of_last(before, drive, kStep));
}

TEST_F(OpenLoopModel, RefusesModelsThatDontKnowTheirVelocities) {
  const TrainedModel model = learned(drive_, "none");
  EXPECT_EQ(message_of<InputError>([&] { open_loop(model); }).substr(0, 28),
            "udot: cannot be rolled out: ");
}

// A vehicle that gravity rights, by a rate of pitch, a pitch and a fin.
struct PitchingDrive {
  std::vector<std::string> inputs{"q", "theta", "delta"};
  std::vector<std::string> targets{"qdot"};
  std::vector<std::array<double, 3>> x;
  std::vector<double> y;

  void drive(std::uint64_t seed, std::size_t samples) {
    constexpr int kFine = 20;
    RandomStream random(seed, "pitching");
    const double rate = random.uniform(0.3, 0.5);
    std::array<double, 3> now{};
    const auto acceleration = [&] { return -0.4 * now[0] - 0.8 * std::sin(now[1]) + 0.5 * now[2]; };
    for (std::size_t i = 0; i < samples * kFine; ++i) {
      const double t = 0.1 * static_cast<double>(i) / kFine;
      now[2] = 0.5 * std::sin(rate * t) + 0.4 * std::sin(0.31 * rate * t);
      now[0] += 0.1 / kFine * acceleration();
      now[1] += 0.1 / kFine * now[0];
      if (i % kFine == 0) {
        x.push_back(now);
        y.push_back(acceleration());
      }
    }
  }
};

TEST(OpenLoop, AttitudeRightsTheVehicleAndIsNoThruster) {
  PitchingDrive drive;
  drive.drive(1, 2500);
  DynamicsModel model(drive.inputs, drive.targets, ModelSettings::from_preset("small", 1));
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    model.update(drive.x[i], std::span(&drive.y[i], 1), 0.1 * static_cast<double>(i));
  }
  ASSERT_NE(model.diagnosis(), nullptr);
  ASSERT_EQ(model.diagnosis()->health().size(), 1U);
  EXPECT_EQ(model.diagnosis()->health()[0].place, 2U);

  PitchingDrive other;
  other.drive(2, 600);
  for (const OpenLoopPart part : {OpenLoopPart::both, OpenLoopPart::steady}) {
    Rollout rollout(open_loop(model.trained(), part));
    rollout.start(other.x[0]);
    for (std::size_t i = 1; i < other.x.size(); ++i) {
      // The log's pitch is that of another vehicle: the rollout has a pitch of its own.
      rollout.advance(std::array{0.0, 1.0, other.x[i][2]}, 0.1);
      ASSERT_NEAR(rollout.velocity(0), other.x[i][0], 0.03) << i;  // of ±0.4
    }
  }
}

}  // namespace
}  // namespace kelpie::open_loop_test
