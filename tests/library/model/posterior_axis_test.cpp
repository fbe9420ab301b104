// SPDX-License-Identifier: Apache-2.0
// The default learner, at the door: DynamicsModel.
#include "model/posterior_axis.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "allocation_count.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/model/stored_past_model.hpp"
#include "kelpie/model/trained_model.hpp"
#include "planar_drive.hpp"
#include "support.hpp"

namespace kelpie::posterior_axis_test {
namespace {

using testing::message_of;
using testing::PlanarDrive;

constexpr double kStep = 0.25;  // seconds

ModelSettings settings(int buffer = 200) {
  ModelSettings settings = ModelSettings::from_preset("default", 2);
  settings.assign("buffer", std::to_string(buffer));
  return settings;
}

DynamicsModel new_model(int buffer = 200) {
  const PlanarDrive names;
  return {names.inputs, names.targets, settings(buffer)};
}

// Motion that grows, so that the units of the kernel move; with noise on the targets.
PlanarDrive noisy_drive(std::size_t samples, double first_size = 0.1) {
  PlanarDrive drive;
  drive.drive(1, samples, kStep);
  RandomStream random(2, "noise");
  for (std::size_t i = 0; i < samples; ++i) {
    const double size = i < 60 ? first_size : 1.0;
    for (double& one : drive.x[i]) {
      one *= size;
    }
    drive.y[i] = PlanarDrive::accelerations(drive.x[i]);
    for (double& one : drive.y[i]) {
      one += 0.02 * random.normal();
    }
  }
  return drive;
}

void learn(DynamicsModel& model, const PlanarDrive& drive, std::size_t from, std::size_t to) {
  for (std::size_t i = from; i < to; ++i) {
    model.update(drive.x[i], drive.y[i], drive.t[i]);
  }
}

// Root mean square of the errors on another drive without noise, in that of the targets.
// `strength`: of the first thruster.
template <typename Model>
double error_elsewhere(const Model& model, double strength = 1.0) {
  PlanarDrive drive;
  drive.drive(9, 800, kStep, strength);
  double wrong = 0.0;
  double size = 0.0;
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    std::array<double, 2> said{};
    model.predict(drive.x[i], said);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      wrong += std::pow(said[axis] - drive.y[i][axis], 2);
      size += std::pow(drive.y[i][axis], 2);
    }
  }
  return std::sqrt(wrong / size);
}

TEST(PosteriorLearner, LearnsTheVehicleAndItsCoefficients) {
  DynamicsModel model = new_model();
  const PlanarDrive drive = noisy_drive(2000);
  learn(model, drive, 0, drive.x.size());
  EXPECT_TRUE(model.ready());
  EXPECT_LT(error_elsewhere(model), 0.05);
  double sum = 0.0;
  for (const MemberShare& member : model.axis(0).members()) {
    EXPECT_GE(member.share, 0.0) << member.name;
    sum += member.share;
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
  for (const Coefficient& one : model.axis(0).coefficients()) {
    EXPECT_GT(one.error, 0.0) << one.term;
    if (one.term == "n1*|n1|") {
      EXPECT_NEAR(one.value, 0.01, 5.0 * one.error);
    }
  }
}

// Inputs and targets of another unit, as of a driver that was set up anew.
void spoil(PlanarDrive& drive, std::size_t from, std::size_t to) {
  for (std::size_t i = from; i < to; ++i) {
    drive.x[i][0] *= 1000.0;
    drive.y[i][0] *= 1000.0;
  }
}

constexpr std::size_t kEnd = std::numeric_limits<std::size_t>::max();

// The first thruster of the drive from a row on, up to another.
void weaken(PlanarDrive& drive, std::size_t from, double strength, std::size_t to = kEnd) {
  for (std::size_t i = from; i < std::min(to, drive.x.size()); ++i) {
    const std::array<double, 2> sound = PlanarDrive::accelerations(drive.x[i]);
    const std::array<double, 2> weak = PlanarDrive::accelerations(drive.x[i], strength);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      drive.y[i][axis] += weak[axis] - sound[axis];
    }
  }
}

// A model put away and taken up again at random moments, about every `every` samples.
DynamicsModel expect_same_life(const PlanarDrive& drive, int buffer, std::size_t first_stop,
                               std::uint64_t every) {
  RandomStream random(9, "stops");
  DynamicsModel whole = new_model(buffer);
  learn(whole, drive, 0, first_stop);
  DynamicsModel broken = whole;
  std::array<double, 2> a{};
  std::array<double, 2> b{};
  for (std::size_t i = first_stop; i < drive.x.size() && !::testing::Test::HasFailure(); ++i) {
    if (random.below(every) == 0) {
      const std::string state = broken.save();
      EXPECT_TRUE(state == whole.save()) << "sample " << i;
      broken = DynamicsModel::resume(new_model(buffer), state);
    }
    learn(whole, drive, i, i + 1);
    learn(broken, drive, i, i + 1);
    whole.predict(drive.x[(7 * i) % drive.x.size()], a);
    broken.predict(drive.x[(7 * i) % drive.x.size()], b);
    EXPECT_EQ(a, b) << "sample " << i;
  }
  EXPECT_TRUE(whole.save() == broken.save());
  return whole;
}

// Also while the kernel has new units, rows of garbage wait, and all is forgotten.
TEST(PosteriorLearner, GoesOnToTheLastBit) {
  PlanarDrive drive = noisy_drive(500);
  spoil(drive, 0, 20);
  spoil(drive, 300, 320);
  expect_same_life(drive, 60, 0, 10);
}

// While a change is open, and when a change is believed.
TEST(PosteriorLearner, GoesOnThroughAChange) {
  PlanarDrive drive = noisy_drive(2600, 1.0);
  for (std::size_t i = 2400; i < drive.x.size(); ++i) {
    drive.y[i][0] *= -1.0;
  }
  EXPECT_GE(expect_same_life(drive, 200, 2400, 10).axis(0).status().tally.changes, 1);
  drive = noisy_drive(2600, 1.0);
  weaken(drive, 2400, 0.2);
  EXPECT_GE(expect_same_life(drive, 200, 2400, 10).axis(0).status().tally.changes, 1);
}

// With a past vehicle that returns.
TEST(PosteriorLearner, GoesOnThroughAReturn) {
  PlanarDrive drive = noisy_drive(3260, 1.0);
  weaken(drive, 2400, 0.2, 3200);
  EXPECT_EQ(expect_same_life(drive, 200, 3180, 10).axis(0).status().tally.recalls, 1);
}

TEST(PosteriorLearner, AllocatesNothingWhileTheUnitsStay) {
  KELPIE_NEEDS_ALLOCATION_COUNT();
  const PlanarDrive drive = noisy_drive(2000, 1.0);
  DynamicsModel model = new_model(100);
  learn(model, drive, 0, 1000);
  std::array<double, 2> y{};
  std::array<double, 8> jacobian{};
  std::array<Prediction, 2> whole{};
  const std::size_t before = testing::allocations;
  for (std::size_t i = 1000; i < drive.x.size(); ++i) {
    learn(model, drive, i, i + 1);
    model.predict(drive.x[i], y);
    model.predict(drive.x[i], whole);
    model.predict_with_jacobian(drive.x[i], y, jacobian);
  }
  EXPECT_EQ(testing::allocations, before);
}

TEST(PosteriorLearner, TakesTheMemoryThatWasTold) {
  KELPIE_NEEDS_ALLOCATION_COUNT();
  const std::vector<std::string> inputs{"u", "v", "r", "th1", "th2", "th3"};
  const std::vector<std::string> targets{"udot", "vdot", "rdot"};
  ModelSettings three = ModelSettings::from_preset("default", 3);
  const std::size_t told = DynamicsModel::bytes(inputs, three);
  EXPECT_LT(told, 35'000'000U);
  const std::size_t before = testing::allocated_bytes;
  const DynamicsModel model(inputs, targets, three);
  const auto taken = static_cast<double>(testing::allocated_bytes - before);
  // Diagnosis, steady part and temporary copies beside the learners.
  EXPECT_GT(taken, 0.9 * static_cast<double>(told));
  EXPECT_LT(taken, 1.6 * static_cast<double>(told));
}

// A budget of one step per update is enough to learn, though later.
TEST(PosteriorLearner, LearnsInSlices) {
  DynamicsModel model = new_model(60);
  const PlanarDrive drive = noisy_drive(3000);
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    model.limit(Budget(1));
    learn(model, drive, i, i + 1);
  }
  EXPECT_LT(error_elsewhere(model), 0.2);
}

TEST(PosteriorLearner, HasAnExactJacobian) {
  DynamicsModel model = new_model();
  const PlanarDrive drive = noisy_drive(1300);
  learn(model, drive, 0, drive.x.size());
  for (const std::size_t i : {100U, 300U, 777U}) {
    std::array<double, 2> y{};
    std::array<double, 8> jacobian{};
    model.predict_with_jacobian(drive.x[i], y, jacobian);
    for (std::size_t input = 0; input < 4; ++input) {
      constexpr double kSmall = 1e-6;
      std::array<double, 2> up{};
      std::array<double, 2> down{};
      auto x = drive.x[i];
      x[input] += kSmall;
      model.predict(x, up);
      x[input] -= 2.0 * kSmall;
      model.predict(x, down);
      for (std::size_t axis = 0; axis < 2; ++axis) {
        EXPECT_NEAR(jacobian[4 * axis + input], (up[axis] - down[axis]) / (2.0 * kSmall), 1e-5);
      }
    }
  }
}

TEST(PosteriorLearner, ATrainedModelSaysTheSame) {
  DynamicsModel model = new_model();
  const PlanarDrive drive = noisy_drive(1300);
  learn(model, drive, 0, drive.x.size());
  const TrainedModel trained = model.trained();
  const DynamicsModel copy = model;
  for (std::size_t i = 0; i < 200; ++i) {
    std::array<double, 2> a{};
    std::array<double, 2> b{};
    std::array<double, 2> c{};
    model.predict(drive.x[i], a);
    trained.predict(drive.x[i], b);
    copy.predict(drive.x[i], c);
    EXPECT_EQ(a, b);
    EXPECT_EQ(a, c);
  }
}

TEST(PosteriorLearner, IntervalsHoldWhatTheyPromise) {
  DynamicsModel model = new_model();
  const PlanarDrive drive = noisy_drive(2500);
  int held = 0;
  int all = 0;
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    learn(model, drive, i, i + 1);
    const Prediction& said = model.decisions()[0].prediction;
    if (i >= 500) {
      ++all;
      held += drive.y[i][0] >= said.lower && drive.y[i][0] <= said.upper ? 1 : 0;
    }
  }
  EXPECT_NEAR(static_cast<double>(held) / all, 0.9, 0.03);
}

// Velocities far beyond those of the rest are those of the vehicle, with and without noise at rest.
TEST(PosteriorLearner, SetsOffAfterARest) {
  constexpr int kRest = 200;
  for (const double noise : {0.0, 1e-3}) {
    RandomStream random(3, "rest");
    DynamicsModel model = new_model();
    for (int i = 0; i < kRest; ++i) {
      std::array<double, 4> x{};
      std::array<double, 2> y{};
      for (double& one : x) {
        one = noise * random.normal();
      }
      for (double& one : y) {
        one = noise * random.normal();
      }
      model.update(x, y, kStep * i);
    }
    PlanarDrive drive = noisy_drive(1500, 1.0);
    for (double& t : drive.t) {
      t += kRest * kStep;
    }
    learn(model, drive, 0, drive.x.size());
    EXPECT_LT(error_elsewhere(model), 0.25) << noise;
  }
}

TEST(PosteriorLearner, DropsABurstOfGarbage) {
  const PlanarDrive clean = noisy_drive(1200, 1.0);
  PlanarDrive drive = clean;
  spoil(drive, 700, 780);
  DynamicsModel model = new_model();
  learn(model, drive, 0, drive.x.size());
  DynamicsModel without = new_model();
  learn(without, clean, 0, 700);
  learn(without, clean, 780, clean.x.size());
  EXPECT_LT(error_elsewhere(model), 1.1 * error_elsewhere(without));
  EXPECT_GE(model.axis(0).status().tally.implausible, 70);
  EXPECT_EQ(model.axis(0).status().tally.changes, 0);
}

// Fifty seconds of noise in all columns, of any size: longer than rows wait for a vehicle.
TEST(PosteriorLearner, DropsNoiseInAllColumns) {
  const PlanarDrive clean = noisy_drive(1400, 1.0);
  for (const double size : {30.0, 1e3, 1e12}) {
    PlanarDrive drive = clean;
    RandomStream random(8, "noise");
    for (std::size_t i = 900; i < 1100; ++i) {
      std::ranges::generate(drive.x[i], [&] { return size * random.normal(); });
      std::ranges::generate(drive.y[i], [&] { return size * random.normal(); });
    }
    DynamicsModel model = new_model();
    learn(model, drive, 0, drive.x.size());
    DynamicsModel without = new_model();
    learn(without, clean, 0, 900);
    learn(without, clean, 1100, clean.x.size());
    EXPECT_LT(error_elsewhere(model), 1.1 * error_elsewhere(without)) << size;
    EXPECT_EQ(model.axis(0).status().tally.changes, 0) << size;
  }
}

// A command that a wire breaks, for half a second: nothing is known of such commands, so no error
// surprises, and such rows would rule all effects of the command by themselves.
TEST(PosteriorLearner, LearnsNothingFromAbsurdCommands) {
  const PlanarDrive clean = noisy_drive(1200, 1.0);
  PlanarDrive drive = clean;
  for (std::size_t i = 900; i < 903; ++i) {
    drive.x[i][2] = i % 2 == 0 ? 1e10 : -3e10;
  }
  DynamicsModel model = new_model();
  std::array<double, 2> said{};
  double most = 0.0;
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    most = std::max(most, std::abs(drive.y[i][0]));
    learn(model, drive, i, i + 1);
    model.predict(drive.x[i], said);
    EXPECT_LT(std::abs(said[0]), 2.5 * most) << i << ": all that is known of commands adds up";
  }
  DynamicsModel without = new_model();
  learn(without, clean, 0, 900);
  learn(without, clean, 903, clean.x.size());
  EXPECT_LT(error_elsewhere(model), 1.1 * error_elsewhere(without));
}

// What a sensor says once spoils nothing beyond its row, however absurd.
TEST(PosteriorLearner, OneAbsurdRowCostsNothing) {
  const PlanarDrive clean = noisy_drive(800, 1.0);
  DynamicsModel without = new_model();
  learn(without, clean, 0, clean.x.size());
  const double error = error_elsewhere(without);
  for (const std::size_t row : {3U, 300U}) {
    for (const double absurd : {-999.0, 1e7, 3.4e38, 1.7e308}) {
      for (const bool in_target : {false, true}) {
        PlanarDrive struck = clean;
        (in_target ? struck.y[row][0] : struck.x[row][0]) = absurd;
        DynamicsModel model = new_model();
        learn(model, struck, 0, struck.x.size());
        EXPECT_LT(error_elsewhere(model), error + 0.02) << row << ", " << absurd << in_target;
      }
    }
  }
}

TEST(PosteriorLearner, ForgetsGarbageAtTheStart) {
  PlanarDrive drive = noisy_drive(600, 1.0);
  RandomStream random(4, "garbage");
  for (std::size_t i = 0; i < 60; ++i) {
    for (double& one : drive.x[i]) {
      one = 1e6 * random.normal();
    }
    for (double& one : drive.y[i]) {
      one = 1e6 * random.normal();
    }
  }
  DynamicsModel model = new_model();
  learn(model, drive, 0, drive.x.size());
  EXPECT_LT(error_elsewhere(model), 0.1);
}

// Thrusters that never ran ahead together: each in its range, yet more acceleration than was seen.
TEST(PosteriorLearner, AddsUpThrustersThatNeverRanTogether) {
  PlanarDrive drive = noisy_drive(1500, 1.0);
  RandomStream random(6, "noise");
  double most = 0.0;
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    double& n1 = drive.x[i][2];
    double& n2 = drive.x[i][3];
    (n1 < n2 ? n1 : n2) = std::min(0.0, std::min(n1, n2));
    drive.y[i] = PlanarDrive::accelerations(drive.x[i]);
    for (double& one : drive.y[i]) {
      one += 0.02 * random.normal();
    }
    most = std::max(most, drive.y[i][0]);
  }
  DynamicsModel model = new_model();
  learn(model, drive, 0, drive.x.size());
  const TrainedModel trained = model.trained();
  for (const double n : {6.0, 7.0, 8.0}) {
    const std::array x{0.3, 0.0, n, n};
    const double is = PlanarDrive::accelerations(x)[0];
    ASSERT_GT(is, 1.1 * most);
    std::array<double, 2> said{};
    std::array<Prediction, 2> assessed{};
    std::array<double, 8> slopes{};
    model.predict(x, said);
    EXPECT_NEAR(said[0], is, 0.05 * is);
    model.predict(x, assessed);
    EXPECT_EQ(assessed[0].value, said[0]);
    model.predict_with_jacobian(x, said, slopes);
    EXPECT_NEAR(said[0], assessed[0].value, 1e-12);
    EXPECT_NEAR(slopes[2], 0.02 * n, 0.002 * n) << "for a controller";
    trained.predict(x, said);
    EXPECT_EQ(said[0], assessed[0].value);
  }
}

// The last second of a log, a manoeuvre as never before, waits when the log ends.
TEST(PosteriorLearner, LearnsWhatWaitsAtTheEndOfALog) {
  constexpr std::size_t kLast = 1196;
  PlanarDrive drive = noisy_drive(1200, 1.0);
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    drive.x[i][1] = i < kLast ? 0.0 : 0.4;  // turns for the first time
    drive.y[i] = PlanarDrive::accelerations(drive.x[i]);
  }
  DynamicsModel model = new_model();
  learn(model, drive, 0, drive.x.size());
  ASSERT_EQ(model.decisions()[1].verdict, Verdict::held_back);
  const auto error = [&] {
    std::array<double, 2> said{};
    model.predict(drive.x.back(), said);
    return std::abs(said[1] - drive.y.back()[1]);
  };
  const double before = error();
  model.learn_held_back();
  EXPECT_LT(error(), 0.5 * before);
  EXPECT_EQ(model.axis(1).status().tally.accepted, 1200);
}

// Full ahead for two seconds, every two minutes: no garbage, for nothing known is contradicted.
TEST(PosteriorLearner, LearnsRareManoeuvres) {
  PlanarDrive drive = noisy_drive(4000, 1.0);
  RandomStream random(5, "noise");
  const auto is_rare = [](std::size_t i) { return i % 480 < 8; };
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    for (std::size_t k = 2; k < 4; ++k) {
      drive.x[i][k] = is_rare(i) ? 30.0 : 0.1 * drive.x[i][k];
    }
    for (std::size_t axis = 0; axis < 2; ++axis) {
      drive.y[i][axis] = PlanarDrive::accelerations(drive.x[i])[axis] + 0.002 * random.normal();
    }
  }
  DynamicsModel model = new_model();
  learn(model, drive, 0, drive.x.size());
  double wrong = 0.0;
  double size = 0.0;
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    if (is_rare(i)) {
      std::array<double, 2> said{};
      model.predict(drive.x[i], said);
      wrong += std::pow(said[0] - drive.y[i][0], 2);
      size += std::pow(drive.y[i][0], 2);
    }
  }
  EXPECT_LT(std::sqrt(wrong / size), 0.1);
}

// What surprises for 36 s is no garbage but another vehicle; a lone row in between, which changes
// nothing, makes the 36 s begin anew.
TEST(PosteriorLearner, BelievesAnotherVehicle) {
  PlanarDrive drive = noisy_drive(1600, 1.0);
  for (std::size_t i = 1000; i < drive.x.size(); ++i) {
    drive.y[i][0] *= -1.0;
  }
  DynamicsModel model = new_model();
  int changes = 0;
  double since = 0.0;
  for (std::size_t i = 0; i < drive.x.size(); ++i) {
    learn(model, drive, i, i + 1);
    if (model.decisions()[0].changed) {
      ++changes;
      since = model.decisions()[0].changed_since;
    }
  }
  EXPECT_EQ(changes, 1);
  EXPECT_GE(since, drive.t[1000]);
  EXPECT_LE(since, drive.t[1000] + 40.0);
}

// Both axes tell of the thruster together, and what was learned of all else stays.
TEST(PosteriorLearner, FollowsAThrusterThatFails) {
  constexpr std::size_t kFails = 2400;
  PlanarDrive drive = noisy_drive(kFails + 80, 1.0);
  weaken(drive, kFails, 0.4);
  DynamicsModel model = new_model();
  learn(model, drive, 0, kFails);
  const double before = error_elsewhere(model, 0.4);
  bool believed = false;
  for (std::size_t i = kFails; i < drive.x.size(); ++i) {
    learn(model, drive, i, i + 1);
    for (const Decision& decision : model.decisions()) {
      EXPECT_EQ(decision.changed, model.decisions()[0].changed) << i;
      believed |= decision.changed && decision.changed_since > drive.t[kFails] - 15.0;
    }
  }
  EXPECT_TRUE(believed) << "within 20 s";
  EXPECT_LT(error_elsewhere(model, 0.4), 0.3 * before);
}

// A thruster fails, and is repaired: the model is that of before the failure within 5 s, where
// learning the repair as a change takes 15 s. Garbage is not the vehicle of before.
TEST(PosteriorLearner, KnowsAVehicleThatReturns) {
  constexpr std::size_t kFails = 2400, kRepaired = 3600, kSoon = 20;
  PlanarDrive drive = noisy_drive(kRepaired + 400, 1.0);
  weaken(drive, kFails, 0.4, kRepaired);
  spoil(drive, kRepaired - 500, kRepaired - 420);
  DynamicsModel model = new_model();
  const auto recalls = [&] { return model.axis(0).status().tally.recalls; };
  learn(model, drive, 0, kFails);
  const double sound = error_elsewhere(model);
  learn(model, drive, kFails, kRepaired);
  EXPECT_EQ(recalls(), 0);
  EXPECT_GT(error_elsewhere(model), 0.2);
  for (std::size_t i = kRepaired; i < kRepaired + kSoon; ++i) {
    learn(model, drive, i, i + 1);
    for (const Decision& decision : model.decisions()) {
      if (decision.recalled > 0) {
        EXPECT_TRUE(decision.changed);
        EXPECT_EQ(decision.recalled, 1);
        EXPECT_GE(decision.changed_since, drive.t[kRepaired] - 10.0);
      }
    }
  }
  EXPECT_EQ(recalls(), 1);
  EXPECT_LT(error_elsewhere(model), 0.1);
  learn(model, drive, kRepaired + kSoon, drive.x.size());
  EXPECT_EQ(recalls(), 1);
  EXPECT_EQ(model.axis(0).status().tally.changes, 2);
  EXPECT_LT(error_elsewhere(model), sound + 0.02);
}

TEST(PosteriorLearner, KeepsNoMoreVehiclesThanTheSettingAllows) {
  PlanarDrive drive = noisy_drive(3600, 1.0);
  weaken(drive, 2400, 0.4);
  for (const std::size_t most : {0U, 1U, 4U}) {
    ModelSettings few = settings();
    few.assign("memory", std::to_string(most));
    DynamicsModel model(drive.inputs, drive.targets, few);
    learn(model, drive, 0, drive.x.size());
    EXPECT_EQ(model.past_models(0).size(), std::min<std::size_t>(most, 2)) << most;
  }
}

// A model of whichever learner is what the posterior begins with.
TEST(PosteriorLearner, GoesOnFromATrainedModel) {
  const PlanarDrive drive = noisy_drive(2000, 1.0);
  for (const char* const learner : {"posterior", "svr"}) {
    ModelSettings given = settings(100);
    given.assign("learner", learner);
    DynamicsModel before(drive.inputs, drive.targets, given);
    learn(before, drive, 0, 1000);
    TrainedModel trained = before.trained();
    trained.settings = settings(100);
    DynamicsModel model = DynamicsModel::resume_from(trained, drive.t[1000]);
    EXPECT_TRUE(model.ready()) << learner;
    EXPECT_LT(error_elsewhere(model), error_elsewhere(before) + 0.03) << learner;
    EXPECT_EQ(model.axis(0).status().tally.accepted, 0);
    learn(model, drive, 1000, drive.x.size());
    EXPECT_LT(model.axis(0).status().tally.implausible, 10) << learner;
    EXPECT_LT(error_elsewhere(model), 0.08) << learner;
  }
}

TEST(PosteriorLearner, BeginsWithAKnownVehicle) {
  const auto make = [](double factor) {
    DynamicsModel model = new_model();
    const std::vector<Coefficient> surge{{"u", -0.2 * factor},
                                         {"u*|u|", -0.6 * factor},
                                         {"n1*|n1|", 0.01 * factor},
                                         {"n2*|n2|", 0.01 * factor}};
    const std::vector<Coefficient> yaw{{"r", -0.3 * factor},
                                       {"r*|r|", -0.5 * factor},
                                       {"n1*|n1|", 0.02 * factor},
                                       {"n2*|n2|", -0.02 * factor}};
    set_nominal(model, 0, factor == 0.0 ? std::vector<Coefficient>{} : surge);
    set_nominal(model, 1, factor == 0.0 ? std::vector<Coefficient>{} : yaw);
    return model;
  };
  const PlanarDrive drive = noisy_drive(1500, 1.0);
  DynamicsModel known = make(1.0);
  DynamicsModel unknown = make(0.0);
  DynamicsModel wrong = make(-1.0);
  for (DynamicsModel* const model : {&known, &unknown, &wrong}) {
    learn(*model, drive, 0, 5);
  }
  EXPECT_LT(error_elsewhere(known), 0.5) << "before the first solve";
  EXPECT_GT(error_elsewhere(unknown), 0.9);
  for (DynamicsModel* const model : {&known, &unknown, &wrong}) {
    learn(*model, drive, 5, 70);
  }
  EXPECT_LT(error_elsewhere(known), 0.6 * error_elsewhere(unknown));
  const std::array ahead{0.0, 0.0, 12.0, 12.0};  // faster than ever
  std::array<double, 2> said{};
  known.predict(ahead, said);
  EXPECT_NEAR(said[0], PlanarDrive::accelerations(ahead)[0], 0.2);
  std::array<double, 2> later{};
  DynamicsModel::resume(make(1.0), known.save()).predict(ahead, later);
  EXPECT_EQ(said, later);
  learn(wrong, drive, 70, drive.x.size());
  EXPECT_LT(error_elsewhere(wrong), 0.08);
}

TEST(PosteriorLearner, RefusesWhatItDoesNotDo) {
  DynamicsModel model = new_model();
  const PlanarDrive drive = noisy_drive(600);
  learn(model, drive, 0, drive.x.size());
  const auto refusal = [&](const StoredPastModel& one, const char* learner = "posterior") {
    ModelSettings given = settings();
    given.assign("learner", learner);
    return message_of<InputError>(
        [&] { DynamicsModel(drive.inputs, drive.targets, given).set_past_models(0, {one}); });
  };
  StoredPastModel past = model.past_models(0).front();
  EXPECT_EQ(refusal(past), "");
  EXPECT_NE(refusal(past, "svr").find("which keeps none"), std::string::npos);
  EXPECT_NE(refusal({}).find("number 0 holds 0 sums"), std::string::npos);
  EXPECT_NE(message_of<InputError>([&] {
              new_model().set_past_models(0, std::vector<StoredPastModel>(5, past));
            }).find("5 given; the settings keep 4"),
            std::string::npos);
  past.sums[4 + model.axis(0).coefficients().size() + 2] = 1e9;  // of the constant and a term
  EXPECT_NE(refusal(past).find("number 1 holds sums of no samples"), std::string::npos);
  const std::vector<std::string> given{"scaling", "buffer"};
  EXPECT_EQ(settings().notes(given, false),
            std::vector<std::string>{"setting scaling has no effect with learner = posterior"});
}

}  // namespace
}  // namespace kelpie::posterior_axis_test
