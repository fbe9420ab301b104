// SPDX-License-Identifier: Apache-2.0
#include "study/stream.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "kelpie/model/dynamics_model.hpp"
#include "log/dataset.hpp"
#include "model/axis_list.hpp"
#include "study/small_log.hpp"
#include "support.hpp"

namespace kelpie::stream_test {
namespace {

// Remembers what it was shown; predicts the last target it saw.
class Spy final : public OnlineRegressor {
 public:
  Decision update(std::span<const double> x, double y, double t) override {
    Decision decision{.prediction = {.value = last_}, .had_model = !shown_.empty()};
    shown_.push_back(x[0]);
    times_.push_back(t);
    last_ = y;
    return decision;
  }
  double predict(std::span<const double> x) const override {
    asked_.push_back(x[0]);
    return last_;
  }
  Status status() const override { return {.ready = !shown_.empty()}; }

  const std::vector<double>& shown() const { return shown_; }
  const std::vector<double>& times() const { return times_; }
  const std::vector<double>& asked() const { return asked_; }

 private:
  std::vector<double> shown_;
  std::vector<double> times_;
  mutable std::vector<double> asked_;
  double last_ = 0.0;
};

// Twelve rows of two configurations; the input is the row's number.
log::Dataset twelve_rows() {
  log::Dataset data;
  data.source = "log.csv";
  data.input_names = {"x"};
  data.target_names = {"y"};
  for (int row = 0; row < 12; ++row) {
    data.inputs.push_back(row);
    data.targets.push_back(0.1 * row);
    data.times_s.push_back(10.0 * row);
    data.configurations.push_back(row < 6 ? 0 : 1);
  }
  return data;
}

const study::Split kSplit{"by hand", {0, 1, 3, 4, 6, 7, 9, 10}, {2, 5, 8, 11}};

// A model of one axis, a spy.
class Watched {
 public:
  study::StreamResult run(const study::StreamOptions& options) {
    return study::run_stream(twelve_rows(), kSplit, model_, options);
  }
  const Spy& spy() const { return dynamic_cast<const Spy&>(model_.axis(0)); }

 private:
  AxisList model_{std::make_unique<Spy>()};
};

TEST(RunStream, ShowsTrainingRowsInOrderAndNeverAHeldOutOne) {
  Watched watched;
  const study::StreamResult result = watched.run({.validate_every = 1});
  EXPECT_EQ(watched.spy().shown(), (std::vector<double>{0, 1, 3, 4, 6, 7, 9, 10}));
  EXPECT_EQ(watched.spy().times().back(), 100.0);
  EXPECT_EQ(result.samples_shown, 8U);
  EXPECT_FALSE(result.interrupted);
}

TEST(RunStream, JudgesOnTheHeldOutRowsOfTheRunningConfiguration) {
  Watched watched;
  const study::StreamResult result = watched.run({.validate_every = 4});
  const study::AxisResult& axis = result.axes.front();
  ASSERT_EQ(axis.validation.size(), 2U);
  EXPECT_EQ(axis.validation[0].configuration, 0);
  EXPECT_EQ(axis.validation[1].configuration, 1);
  // Two looks and as many ends of stages of two rows each, then all four at the end, and
  // those of the last configuration again, for their novelty.
  EXPECT_EQ(watched.spy().asked(),
            (std::vector<double>{2, 5, 2, 5, 8, 11, 8, 11, 2, 5, 8, 11, 8, 11}));
  // The spy says 0.4 of the targets 0.2 and 0.5 after four samples: 1 − (0.04 + 0.01) / 0.045.
  EXPECT_NEAR(axis.validation[0].r2, 1.0 - 0.05 / 0.045, 1e-12);
  EXPECT_EQ(axis.r2_final, axis.validation[1].r2);
  EXPECT_NEAR(axis.r2_mean, 0.5 * (axis.validation[0].r2 + axis.validation[1].r2), 1e-12);
  EXPECT_TRUE(std::isnan(axis.r2_min_after_1000));
}

TEST(RunStream, KeepsWhatWasPredictedJustBeforeEverySwitch) {
  Watched watched;
  const study::StreamResult result = watched.run({});
  const std::vector<study::StageEnd>& stages = result.axes.front().stages;
  ASSERT_EQ(stages.size(), 2U);
  EXPECT_EQ(stages[0].configuration, 0);
  EXPECT_EQ(stages[0].samples, 4U);
  EXPECT_EQ(stages[0].time_s, (std::vector<double>{20, 50}));
  EXPECT_EQ(stages[0].truth, (std::vector<double>{0.1 * 2, 0.1 * 5}));
  EXPECT_EQ(stages[0].predicted, (std::vector<double>{0.4, 0.4}));  // not what it says later
  EXPECT_NEAR(stages[0].r2, 1.0 - 0.05 / 0.045, 1e-12);
  EXPECT_EQ(stages[1].configuration, 1);
  EXPECT_EQ(stages[1].samples, 8U);
  EXPECT_EQ(stages[1].r2, result.axes.front().r2_final);
}

TEST(RunStream, LooksAlsoWhereAskedTo) {
  Watched watched;
  const study::StreamResult result = watched.run({.validate_every = 4, .also_at = {3, 4, 7}});
  std::vector<std::size_t> samples;
  for (const study::ValidationPoint& point : result.axes.front().validation) {
    samples.push_back(point.samples);
  }
  EXPECT_EQ(samples, (std::vector<std::size_t>{3, 4, 7, 8}));
}

TEST(RunStream, PrequentialScoreLeavesOutWhatWasSaidWithoutAModel) {
  Watched watched;
  study::StreamResult result = watched.run({});
  study::add_baselines(twelve_rows(), kSplit, {}, result);
  // Truth 0.1 .3 .4 .6 .7 .9 1.0 against the value before each: 0 .1 .3 .4 .6 .7 .9.
  const std::vector<double> truth{0.1, 0.3, 0.4, 0.6, 0.7, 0.9, 1.0};
  const double residual = 4 * 0.01 + 3 * 0.04;
  double total = 0.0;
  for (const double y : truth) {
    total += std::pow(y - 4.0 / 7.0, 2);
  }
  EXPECT_NEAR(result.axes.front().prequential_r2, 1.0 - residual / total, 1e-12);
  // Its baseline is judged on the same samples, and says the same as this learner.
  EXPECT_NEAR(result.axes.front().baselines.last_value.prequential_r2, 1.0 - residual / total,
              1e-12);
}

TEST(RunStream, StoppedEarlyItStillJudgesWhatThereIs) {
  Watched watched;
  const study::StreamResult result = watched.run(
      {.validate_every = 100, .keep_going = [](std::size_t shown) { return shown < 3; }});
  EXPECT_TRUE(result.interrupted);
  EXPECT_EQ(result.samples_shown, 3U);
  ASSERT_EQ(result.axes.front().validation.size(), 1U);
  EXPECT_EQ(result.axes.front().validation.front().samples, 3U);
  EXPECT_EQ(result.axes.front().update_us.size(), 3U);
  EXPECT_EQ(result.axes.front().held_out_predicted.size(), 4U);
}

// The first rows wait for a scale, and after it for their turn.
TEST(RunStream, ALogThatEndsWhileRowsWaitIsLearnedToItsLastRow) {
  const log::Dataset data = testing::small_log(52);
  ModelSettings settings = ModelSettings::from_preset("default", 1);
  settings.assign("warmup", "50");
  DynamicsModel model(data.input_names, data.target_names, settings);
  const study::Split split{"all", testing::all_rows(52), {}};
  const Tally tally = study::run_stream(data, split, model, {}).axes.front().status.tally;
  EXPECT_EQ(tally.accepted + tally.explained + tally.duplicate, 52);
}

// The real log, a short stretch: what the documentation promises of it holds.
TEST(RunStream, LearnsTheRealLog) {
  const auto file = testing::data_file("dagon_config1.csv");
  if (file.empty()) {
    GTEST_SKIP() << "the log of AUV Dagon is not here";
  }
  const log::Table table = log::read_csv(file);
  const log::Dataset data = log::make_dataset(table, log::guess_roles(table, {.rate_hz = 4.0}));
  const study::Split split = study::make_split(data, {.kind = study::SplitKind::blocks});
  DynamicsModel model(data.input_names, data.target_names,
                      ModelSettings::from_preset("default", 3));
  const study::StreamOptions options{.validate_every = 500,
                                     .keep_going = [](std::size_t shown) { return shown < 2500; }};
  const study::StreamResult result = study::run_stream(data, split, model, options);
  ASSERT_EQ(result.axes.size(), 3U);
  for (const study::AxisResult& axis : result.axes) {
    EXPECT_GT(axis.r2_final, 0.6) << axis.name;
    EXPECT_GT(axis.prequential_r2, 0.9) << axis.name;
    EXPECT_GT(axis.corrected_r2, 0.98) << axis.name;
    EXPECT_NEAR(axis.corrected_coverage.share, 0.9, 0.02) << axis.name;
    EXPECT_LT(axis.corrected_coverage.mean_width, axis.coverage.mean_width) << axis.name;
    EXPECT_LE(axis.status.kkt_gap, 1e-3) << axis.name;
  }
}

}  // namespace
}  // namespace kelpie::stream_test
