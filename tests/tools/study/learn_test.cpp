// SPDX-License-Identifier: Apache-2.0
#include "study/learn.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "kelpie/core/error.hpp"
#include "study/baselines.hpp"
#include "study/small_log.hpp"
#include "study/training_scales.hpp"
#include "support.hpp"

namespace kelpie::learn_plan_test {
namespace {

constexpr std::size_t kRows = 600;

study::LearnPlan plan(const std::string& align = "none") {
  return study::plan_learning(testing::small_log(kRows),
                              {.kind = study::SplitKind::pieces, .seed = 7},
                              testing::small_settings(1, "40"), align);
}

TEST(LearnPlan, FillsInEveryFieldOfTheResult) {
  const study::LearnPlan all = plan();
  DynamicsModel model = study::make_model(all);
  const study::StreamResult result = study::learn(all, model, {});
  EXPECT_TRUE(model.ready());
  EXPECT_EQ(result.training_rows, all.split.training.size());
  EXPECT_EQ(result.samples_shown, result.training_rows);
  EXPECT_EQ(result.seed, 7U);
  EXPECT_EQ(result.scales, "of the samples so far");
  EXPECT_EQ(result.alignment.why, "as given by --align");
  EXPECT_EQ(result.settings, all.settings.values());
  EXPECT_EQ(result.memory_bytes, DynamicsModel::bytes(all.data.input_names, all.settings));
  EXPECT_FALSE(result.diagnosis.why_not.empty());  // no states
  EXPECT_TRUE(std::isfinite(result.axes.front().baselines.mean.r2_final));
}

TEST(LearnPlan, IsTheStreamThatRunStreamRuns) {
  const study::LearnPlan all = plan();
  DynamicsModel learned = study::make_model(all);
  DynamicsModel streamed = study::make_model(all);
  const study::StreamResult result = study::learn(all, learned, {.validate_every = 50});
  const study::StreamResult stream =
      study::run_stream(all.data, all.split, streamed, {.validate_every = 50});
  EXPECT_EQ(learned.save(), streamed.save());
  EXPECT_EQ(result.axes.front().r2_final, stream.axes.front().r2_final);
  EXPECT_EQ(result.axes.front().one_step.predicted, stream.axes.front().one_step.predicted);
}

// A vehicle that gravity rights; roll in the unit that `unit` of it are a radian, and the heading.
study::LearnPlan rolling(double unit) {
  log::Dataset data = testing::small_log(kRows);
  data.input_names = {"p", "roll", "yaw"};
  data.inputs.clear();
  data.targets.clear();
  for (std::size_t i = 0; i < kRows; ++i) {
    const double roll =
        std::sin(0.37 * static_cast<double>(i)) + 0.5 * std::sin(0.05 * static_cast<double>(i));
    const double p = std::cos(0.21 * static_cast<double>(i));
    data.inputs.insert(data.inputs.end(),
                       {p, unit * roll, std::fmod(0.1 * static_cast<double>(i), 6.28)});
    data.targets.push_back(-2.0 * std::sin(roll) - 0.5 * p);
  }
  ModelSettings settings = testing::small_settings(1, "40");
  settings.assign("terms", "auto");
  return study::plan_learning(std::move(data), {.kind = study::SplitKind::pieces, .seed = 7},
                              settings, "none");
}

TEST(LearnPlan, AnglesInDegreesAreKnownByTheirSize) {
  EXPECT_EQ(rolling(1.0).settings.shared.terms, "auto");
  EXPECT_EQ(rolling(180.0 / std::numbers::pi).settings.shared.terms, "auto:degrees");
  EXPECT_EQ(rolling(1000.0).settings.shared.terms, "quadratic");  // a command
  std::vector<double> r2;
  for (const double unit : {1.0, 180.0 / std::numbers::pi}) {
    const study::LearnPlan plan = rolling(unit);
    DynamicsModel model = study::make_model(plan);
    r2.push_back(study::learn(plan, model, {}).axes.front().r2_final);
    std::array<double, 1> north{};
    std::array<double, 1> east{};
    model.predict(std::vector{0.3, 0.2 * unit, 0.0}, north);
    model.predict(std::vector{0.3, 0.2 * unit, 1.6}, east);
    EXPECT_NEAR(north[0], east[0], 2e-3);  // the heading acts on nothing
  }
  EXPECT_GT(r2[0], 0.99);
  EXPECT_NEAR(r2[0], r2[1], 1e-3);
}

TEST(LearnPlan, AStoppedRunHasItsBaselinesOnTheShownSamples) {
  const study::LearnPlan all = plan();
  DynamicsModel model = study::make_model(all);
  const study::StreamResult result =
      study::learn(all, model, {.keep_going = [](std::size_t shown) { return shown < 200; }});
  EXPECT_TRUE(result.interrupted);
  EXPECT_EQ(result.samples_shown, 200U);
  EXPECT_TRUE(std::isfinite(result.axes.front().baselines.mean.prequential_r2));
}

TEST(LearnPlan, TheScaleComesFromWhereThePlanSays) {
  study::LearnPlan all = plan();
  all.settings.assign("learner", "svr");
  EXPECT_EQ(all.scales_text(), "first 60 training samples");
  const std::vector<AxisScaling> training =
      study::training_scales(all.data, all.split.training, all.settings.shared);
  const auto saved = [&] { return study::make_model(all).save(); };
  const std::string first = saved();
  all.scales = "train";
  EXPECT_EQ(all.scales_text(), "all training rows (known beforehand)");
  const std::string train = saved();
  EXPECT_NE(train, first);
  all.scales = "other.json";
  all.given_scales = training;
  EXPECT_EQ(all.scales_text(), "other.json");
  EXPECT_EQ(saved(), train);
  all.from = "model.json";
  EXPECT_EQ(all.scales_text(), "as in model.json");
}

TEST(LearnPlan, AKnownAlignmentIsNotSearched) {
  const AlignmentResult known{.alignment = {}, .gain = 0.0, .why = "as in model.json"};
  const study::LearnPlan all =
      study::plan_learning(testing::small_log(kRows), {.kind = study::SplitKind::pieces},
                           testing::small_settings(1, "40"), "auto", known);
  EXPECT_EQ(all.alignment.why, "as in model.json");
  EXPECT_EQ(all.data.inputs, testing::small_log(kRows).inputs);
}

TEST(LearnPlan, ALogWithoutAScaleIsRefused) {
  log::Dataset data = testing::small_log(kRows);
  for (std::size_t row = 0; row < kRows; ++row) {
    data.inputs[2 * row] = 1.0;
  }
  ModelSettings full = testing::small_settings(1, "40");
  full.assign("scaling", "full");  // `diagonal` leaves a constant input out
  const study::LearnPlan all =
      study::plan_learning(std::move(data), {.kind = study::SplitKind::pieces}, full, "none");
  const std::string message =
      testing::message_of<InputError>([&] { static_cast<void>(study::make_model(all)); });
  EXPECT_NE(message.find("u: is constant"), std::string::npos) << message;
}

}  // namespace
}  // namespace kelpie::learn_plan_test
