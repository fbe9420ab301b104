// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/dynamics_model.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "allocation_count.hpp"
#include "kelpie/core/error.hpp"
#include "kelpie/core/random.hpp"
#include "kelpie/model/trained_model.hpp"
#include "model/model_axis.hpp"
#include "support.hpp"
#include "vehicle_stream.hpp"

namespace kelpie::dynamics_model_test {
namespace {

using testing::Drive;
using testing::drive;
using testing::message_of;

ModelSettings settings(int warmup = 50) {
  ModelSettings values = ModelSettings::from_preset("default", 2);
  values.shared.warmup = warmup;
  values.assign("epsilon", "0.02");
  values.assign("gamma", "0.5");
  return values;
}

ModelSettings svr_settings(int warmup = 50) {
  ModelSettings values = settings(warmup);
  values.assign("learner", "svr");
  return values;
}

void learn(DynamicsModel& model, const Drive& samples, double start_s = 0.0) {
  for (std::size_t i = 0; i < samples.x.size(); ++i) {
    model.update(samples.x[i], samples.y[i], start_s + 0.1 * static_cast<double>(i));
  }
}

double worst_relative_error(const DynamicsModel& model, const Drive& samples) {
  std::array<double, 2> y{};
  std::array<double, 2> worst{};
  std::array<double, 2> largest{};
  for (std::size_t i = 0; i < samples.x.size(); ++i) {
    model.predict(samples.x[i], y);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const double centre = axis == 0 ? 0.0 : 50.0;
      worst[axis] = std::max(worst[axis], std::abs(y[axis] - samples.y[i][axis]));
      largest[axis] = std::max(largest[axis], std::abs(samples.y[i][axis] - centre));
    }
  }
  return std::max(worst[0] / largest[0], worst[1] / largest[1]);
}

TEST(DynamicsModel, LearnsAxesOfVeryDifferentUnitsInTheirOwn) {
  const Drive samples = drive(1, 2000);
  DynamicsModel model(samples.inputs, samples.targets, settings(400));
  learn(model, samples);
  EXPECT_TRUE(model.ready());
  EXPECT_LT(worst_relative_error(model, drive(2, 500)), 0.1);
}

// surge = thrust |thrust| / 800,000 − 0.9 speed |speed|, see vehicle_stream.hpp.
TEST(DynamicsModel, ReadsPhysicalCoefficientsBackInTheLogsUnits) {
  Drive samples = drive(4, 1500);
  ModelSettings with_terms = settings(200);
  with_terms.assign("terms", "speed*|speed|; thrust*|thrust|");
  with_terms.assign("fine", "0");
  with_terms.assign("c", "0.1");
  with_terms.assign("lambda", "100");
  DynamicsModel model(samples.inputs, samples.targets, with_terms);
  EXPECT_TRUE(model.axis(0).coefficients().empty());
  learn(model, samples);
  const std::vector<Coefficient> before = model.axis(0).coefficients();
  ASSERT_EQ(before.size(), 2U);
  EXPECT_EQ(before[0].term, "speed*|speed|");
  EXPECT_NEAR(before[0].value, -0.9, 0.1);
  EXPECT_NEAR(before[1].value, 1.25e-6, 0.05e-6);
  // A thruster at half its effect is a coefficient that falls to half.
  for (std::size_t i = 0; i < samples.x.size(); ++i) {
    const double thrust = samples.x[i][1];
    samples.y[i][0] -= 0.5 * thrust * std::abs(thrust) / 800'000.0;
  }
  learn(model, samples, 150.0);
  EXPECT_NEAR(model.axis(0).coefficients()[1].value, 0.625e-6, 0.1e-6);
}

TEST(DynamicsModel, HoldsSamplesBackUntilTheScaleIsKnownAndThenLearnsThem) {
  const Drive samples = drive(3, 60);
  DynamicsModel model(samples.inputs, samples.targets, svr_settings(50));
  std::array<double, 2> y{};
  for (std::size_t i = 0; i < 49; ++i) {
    model.update(samples.x[i], samples.y[i], 0.0);
    EXPECT_EQ(model.decisions()[0].verdict, Verdict::held_back);
  }
  // Then all of them, in the order in which they came, a few with every update.
  std::int64_t before = 0;
  for (std::size_t i = 49; i < 60; ++i) {
    model.update(samples.x[i], samples.y[i], 0.0);
    const Tally tally = model.axis(0).status().tally;
    const std::int64_t learned = tally.accepted + tally.explained + tally.duplicate;
    EXPECT_TRUE(model.axis(0).status().ready);
    EXPECT_LE(learned - before, 10) << i;
    before = learned;
  }
  EXPECT_EQ(before, 60);
  EXPECT_EQ(model.decisions()[0].verdict, Verdict::accepted);
  DynamicsModel told(samples.inputs, samples.targets, svr_settings(50),
                     std::array{*model.mechanisms(0).scaling(), *model.mechanisms(1).scaling()});
  for (std::size_t i = 0; i < 60; ++i) {
    told.update(samples.x[i], samples.y[i], 0.0);
  }
  model.predict(samples.x[7], y);
  std::array<double, 2> same{};
  told.predict(samples.x[7], same);
  EXPECT_EQ(y, same);
  DynamicsModel short_log(samples.inputs, samples.targets, svr_settings(50));
  for (std::size_t i = 0; i < 50; ++i) {
    short_log.update(samples.x[i], samples.y[i], 0.0);
  }
  short_log.learn_held_back();
  const Tally all = short_log.axis(0).status().tally;
  EXPECT_EQ(all.accepted + all.explained + all.duplicate, 50);
}

TEST(DynamicsModel, PredictsFromTheTenthSampleOn) {
  const Drive samples = drive(3, 50);
  DynamicsModel model(samples.inputs, samples.targets, settings(50));
  std::array<double, 2> y{};
  double mean = 0.0;
  for (std::size_t i = 0; i < 9; ++i) {
    model.update(samples.x[i], samples.y[i], 0.1 * static_cast<double>(i));
    EXPECT_FALSE(model.decisions()[0].had_model);
    mean += samples.y[i][0] / 9.0;
  }
  EXPECT_FALSE(model.ready());
  model.predict(samples.x[0], y);
  EXPECT_NEAR(y[0], mean, 1e-12);
  double by_model = 0.0;
  double by_mean = 0.0;
  for (std::size_t i = 9; i < 50; ++i) {
    model.update(samples.x[i], samples.y[i], 0.1 * static_cast<double>(i));
    EXPECT_TRUE(model.ready());
    const Decision& decision = model.decisions()[0];
    EXPECT_EQ(decision.had_model, i > 9) << i;
    EXPECT_EQ(std::isfinite(decision.prediction.upper), i >= 40) << i;
    if (i > 20) {
      by_model += std::abs(decision.prediction.value - samples.y[i][0]);
      by_mean += std::abs(mean - samples.y[i][0]);
    }
  }
  EXPECT_LT(by_model, 0.5 * by_mean);
}

TEST(DynamicsModel, PredictionsComeWithAnIntervalAndNovelty) {
  const Drive samples = drive(5, 1500);
  DynamicsModel model(samples.inputs, samples.targets, settings(100));
  std::array<Prediction, 2> whole{};
  model.predict(samples.x[0], whole);
  EXPECT_EQ(whole[0].upper, std::numeric_limits<double>::infinity());
  EXPECT_EQ(whole[0].novelty, 1.0);
  std::array<double, 2> value{};
  int held = 0;
  for (std::size_t i = 0; i < samples.x.size(); ++i) {
    model.predict(samples.x[i], whole);
    model.predict(samples.x[i], value);
    EXPECT_EQ(whole[0].value, value[0]);
    model.update(samples.x[i], samples.y[i], 0.1 * static_cast<double>(i));
    const Decision& decision = model.decisions()[0];
    if (i >= 500) {
      // What was said of the place beforehand is what the decision is judged by.
      EXPECT_NEAR(decision.prediction.lower, whole[0].lower, 1e-9);
      EXPECT_NEAR(decision.prediction.upper, whole[0].upper, 1e-9);
      held += decision.prediction.lower <= samples.y[i][0] &&
                      samples.y[i][0] <= decision.prediction.upper
                  ? 1
                  : 0;
    }
  }
  EXPECT_NEAR(held / 1000.0, 0.9, 0.03);  // three standard errors of fair tosses
  const std::size_t before = testing::allocations;
  model.predict(std::array{1e6, 1e6}, whole);
  EXPECT_EQ(testing::allocations, before);
  EXPECT_EQ(whole[0].novelty, 1.0);
  const TrainedModel trained = model.trained();
  std::array<Prediction, 2> copy{};
  for (const std::vector<double>& x : drive(6, 50).x) {
    model.predict(x, whole);
    trained.predict(x, copy);
    EXPECT_EQ(copy[1].value, whole[1].value);
    EXPECT_EQ(copy[1].lower, whole[1].lower);
    EXPECT_EQ(copy[1].upper, whole[1].upper);
    EXPECT_EQ(copy[1].novelty, whole[1].novelty);
  }
}

TEST(DynamicsModel, LeavesOutAThrusterThatHasNotMovedYet) {
  Drive samples = drive(4, 300);
  for (std::size_t i = 0; i < 100; ++i) {
    samples.x[i][1] = 0.0;
  }
  DynamicsModel model(samples.inputs, samples.targets, settings(50));
  for (std::size_t i = 0; i < 100; ++i) {
    model.update(samples.x[i], samples.y[i], 0.1 * static_cast<double>(i));
  }
  EXPECT_TRUE(model.ready());
  std::array<double, 2> at_rest{};
  std::array<double, 2> moved{};
  model.predict(samples.x[90], at_rest);
  model.predict(std::array{samples.x[90][0], 500.0}, moved);
  EXPECT_EQ(moved, at_rest);
  for (std::size_t i = 100; i < 300; ++i) {
    model.update(samples.x[i], samples.y[i], 0.1 * static_cast<double>(i));
  }
  model.predict(samples.x[290], moved);
  EXPECT_NEAR(moved[0], samples.y[290][0], 0.2);
}

// What a sensor says once spoils nothing beyond its row, however absurd.
TEST(DynamicsModel, OneAbsurdRowCostsNothing) {
  const Drive samples = drive(5, 800);
  DynamicsModel clean(samples.inputs, samples.targets, settings(50));
  learn(clean, samples);
  const double error = worst_relative_error(clean, drive(8, 500));
  for (const std::size_t row : {3U, 300U}) {
    for (const double absurd : {-999.0, 1e7, 3.4e38, 1.7e308}) {
      for (const std::size_t column : {0U, 1U, 2U}) {
        Drive struck = samples;
        (column < 2 ? struck.x[row][column] : struck.y[row][0]) = absurd;
        DynamicsModel model(struck.inputs, struck.targets, settings(50));
        learn(model, struck);
        EXPECT_LT(worst_relative_error(model, drive(8, 500)), error + 0.025)
            << row << ", " << absurd << ", " << column;
      }
    }
  }
}

// A vehicle that begins with hardly any motion: the scale of that is no scale for what follows.
TEST(DynamicsModel, FollowsTheScaleOfWhatTheFirstSamplesDidNotShow) {
  Drive samples = drive(7, 1500);
  for (std::size_t i = 0; i < 100; ++i) {
    for (const std::size_t k : {0U, 1U}) {
      samples.x[i][k] *= 0.02;
      samples.y[i][k] = k == 0 ? 1e-3 * samples.y[i][k] : 50.0 + 0.02 * (samples.y[i][k] - 50.0);
    }
  }
  DynamicsModel model(samples.inputs, samples.targets, settings(50));
  learn(model, samples);
  const TrainedModel trained = model.trained();
  std::array<double, 2> learned{};
  std::array<double, 2> kept{};
  model.predict(samples.x[700], learned);
  trained.predict(samples.x[700], kept);
  EXPECT_EQ(learned, kept);
  EXPECT_LT(worst_relative_error(model, drive(8, 500)), 0.15);
}

TEST(DynamicsModel, AGivenScalingIsUsedFromTheFirstSample) {
  const Drive samples = drive(5, 400);
  DynamicsModel first(samples.inputs, samples.targets, svr_settings(400));
  learn(first, samples);
  const std::array scaling{*first.mechanisms(0).scaling(), *first.mechanisms(1).scaling()};
  DynamicsModel second(samples.inputs, samples.targets, svr_settings(), scaling);
  second.update(samples.x[0], samples.y[0], 0.0);
  EXPECT_EQ(second.decisions()[0].verdict, Verdict::accepted);
  learn(second, samples);
  EXPECT_LT(worst_relative_error(second, samples), 0.15);
}

// Raw units must not matter: metres or millimetres, the same model.
// A glider's sink rate follows its pitch. Depth says nothing, but a fit of few samples always finds
// a little of its square, which would outweigh the pitch far below the depths seen.
TEST(DynamicsModel, AnInputFarBeyondItsRangeDoesNotOutweighTheOthers) {
  RandomStream random(1, "glider");
  DynamicsModel model({"pitch", "depth"}, {"w"}, ModelSettings::from_preset("default", 1));
  const auto sink_rate = [](double pitch) { return 0.2 * std::sin(pitch); };
  for (int i = 0; i < 1000; ++i) {
    const double pitch = 0.5 * std::sin(0.05 * i) + 0.05 * random.normal();
    const double depth = 100.0 - 100.0 * std::cos(0.01 * i);
    model.update(std::array{pitch, depth}, std::array{sink_rate(pitch) + 0.03 * random.normal()},
                 20.0 * i);
  }
  double squares = 0.0;
  for (double pitch = -0.5; pitch <= 0.5; pitch += 0.1) {
    std::array<double, 1> w{};
    model.predict(std::array{pitch, 700.0}, w);
    squares += std::pow(w[0] - sink_rate(pitch), 2) / 11.0;
  }
  EXPECT_LT(std::sqrt(squares), 0.02) << "a tenth of what pitch does";
}

TEST(DynamicsModel, IsInvariantToUnits) {
  const Drive samples = drive(6, 500);
  Drive scaled = samples;
  for (std::size_t i = 0; i < samples.x.size(); ++i) {
    scaled.x[i][0] = 1024.0 * samples.x[i][0];
    scaled.y[i][0] = 0.5 * samples.y[i][0];
  }
  DynamicsModel a(samples.inputs, samples.targets, settings());
  DynamicsModel b(samples.inputs, samples.targets, settings());
  learn(a, samples);
  learn(b, scaled);
  std::array<double, 2> ya{};
  std::array<double, 2> yb{};
  for (std::size_t i = 0; i < samples.x.size(); i += 7) {
    a.predict(samples.x[i], ya);
    b.predict(scaled.x[i], yb);
    EXPECT_NEAR(0.5 * ya[0], yb[0], 1e-9);
    EXPECT_NEAR(ya[1], yb[1], 1e-9);
  }
}

TEST(DynamicsModel, BadSamplesAreCountedAndLeaveTheModelAlone) {
  const Drive samples = drive(7, 200);
  DynamicsModel clean(samples.inputs, samples.targets, settings());
  DynamicsModel hurt(samples.inputs, samples.targets, settings());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < samples.x.size(); ++i) {
    clean.update(samples.x[i], samples.y[i], 0.0);
    hurt.update(std::array{nan, 1.0}, samples.y[i], 0.0);
    hurt.update(samples.x[i], samples.y[i], 0.0);
  }
  EXPECT_EQ(hurt.axis(0).status().tally.invalid, 200);
  std::array<double, 2> a{};
  std::array<double, 2> b{};
  clean.predict(samples.x[5], a);
  hurt.predict(samples.x[5], b);
  EXPECT_EQ(a, b);
}

TEST(DynamicsModel, RefusesWhatDoesNotFit) {
  const auto make = [](std::size_t inputs, std::size_t targets, std::size_t axes) {
    DynamicsModel(std::vector<std::string>(inputs, "x"), std::vector<std::string>(targets, "y"),
                  ModelSettings::from_preset("default", axes));
  };
  EXPECT_EQ(message_of<InputError>([&] { make(0, 1, 1); }),
            "inputs: 0 given; a model takes 1 to 64");
  EXPECT_EQ(message_of<InputError>([&] { make(65, 1, 1); }),
            "inputs: 65 given; a model takes 1 to 64");
  EXPECT_EQ(message_of<InputError>([&] { make(2, 0, 0); }),
            "targets: none given; a model needs one or more");
  EXPECT_EQ(message_of<InputError>([&] { make(2, 2, 1); }),
            "settings: for 1 axes; there are 2 targets");
  EXPECT_EQ(message_of<InputError>([&] { make(2, 1, 1); }), "inputs: name 'x' twice");
  EXPECT_EQ(message_of<InputError>([&] { make(1, 2, 2); }), "targets: name 'y' twice");
  const DynamicsModel of_itself({"x", "n"}, {"x"}, ModelSettings::from_preset("default", 1));
  EXPECT_EQ(of_itself.axes(), 1U);
}

TEST(TrainedModel, PredictsWhatTheModelItWasTakenFromDid) {
  const Drive samples = drive(8, 600);
  DynamicsModel model(samples.inputs, samples.targets, settings());
  learn(model, samples);
  const TrainedModel trained = model.trained();
  std::array<double, 2> a{};
  std::array<double, 2> b{};
  for (const std::vector<double>& x : samples.x) {
    model.predict(x, a);
    trained.predict(x, b);
    ASSERT_EQ(a, b);
  }
}

}  // namespace
}  // namespace kelpie::dynamics_model_test
