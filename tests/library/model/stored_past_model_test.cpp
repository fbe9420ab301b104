// SPDX-License-Identifier: Apache-2.0
#include "kelpie/model/stored_past_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "kelpie/core/random.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "model/dynamics_axis.hpp"
#include "model/model_axis.hpp"

namespace kelpie::stored_past_model_test {
namespace {

// A vehicle on one axis, in units far from 1; a damaged thruster has half its thrust.
class Trial {
 public:
  explicit Trial(double start_s, const char* scaling = "diagonal", int memory = 4)
      : time_(start_s), model_({"u", "n"}, {"udot"}, settings(scaling, memory)) {}

  // Returns the numbers of past models taken up.
  std::vector<std::int64_t> drive(double thrust, int samples) {
    std::vector<std::int64_t> recalled;
    for (int i = 0; i < samples; ++i) {
      phase_ += random_.uniform(0.02, 0.3);
      const double n = 300.0 * std::sin(phase_) + 50.0 * random_.normal();
      const double udot = 1e-5 * thrust * n * std::abs(n) - 4.0 * u_ * std::abs(u_);
      const std::array<double, 2> x{u_, n};
      model_.update(x, std::array{udot}, time_);
      if (model_.decisions()[0].recalled > 0) {
        recalled.push_back(model_.decisions()[0].recalled);
      }
      u_ += 0.2 * udot;
      time_ += 0.25;
    }
    return recalled;
  }

  DynamicsModel& model() { return model_; }

 private:
  static ModelSettings settings(const char* scaling, int memory) {
    ModelSettings settings = ModelSettings::from_preset("default", 1);
    settings.assign("scaling", scaling);
    settings.assign("memory", std::to_string(memory));
    for (const auto& [name, value] : std::map<std::string, std::string>{{"buffer", "300"},
                                                                        {"terms", "none"},
                                                                        {"epsilon", "0.05"},
                                                                        {"c", "10"},
                                                                        {"fine", "0"}}) {
      settings.assign(name, value);
    }
    return settings;
  }

  double u_ = 0.0;
  double phase_ = 0.0;
  double time_;
  RandomStream random_{1, "trial"};
  DynamicsModel model_;
};

TEST(StoredPastModel, HoldsTheSamplesInTheUnitsOfTheLog) {
  Trial trial(100.0, "full");
  trial.drive(1.0, 1200);
  const std::vector<StoredPastModel> memory = trial.model().past_models(0);
  ASSERT_EQ(memory.size(), 1U);
  const StoredPastModel& model = memory.front();
  ASSERT_GT(model.targets.size(), 50U);
  ASSERT_EQ(model.inputs.size(), 2 * model.targets.size());
  for (std::size_t i = 0; i < model.targets.size(); ++i) {
    const double u = model.inputs[2 * i];
    const double n = model.inputs[2 * i + 1];
    EXPECT_NEAR(model.targets[i], 1e-5 * n * std::abs(n) - 4.0 * u * std::abs(u), 1e-9);
    EXPECT_GE(model.times_s[i], 100.0);
  }
}

// Another day, another scale, and the clock starts anew.
TEST(StoredPastModel, ALaterRunKnowsTheVehicleOfAnEarlierOne) {
  Trial yesterday(5000.0, "full");
  yesterday.drive(0.5, 1200);
  Trial today(0.0);
  today.model().set_past_models(0, yesterday.model().past_models(0));
  EXPECT_EQ(today.model().past_models(0).size(), 1U);  // before there is a scale
  EXPECT_TRUE(today.drive(1.0, 1000).empty());
  EXPECT_EQ(today.model().past_models(0).size(), 2U);
  EXPECT_EQ(today.drive(0.5, 100), (std::vector<std::int64_t>{1}));
  EXPECT_EQ(today.model().past_models(0)[1].info.number, 2);
}

TEST(StoredPastModel, ALaterRunBeginsWithTheVehicleOfAnEarlierOne) {
  Trial yesterday(5000.0);
  yesterday.drive(1.0, 1200);
  const std::vector<StoredPastModel> memory = yesterday.model().past_models(0);
  Trial today(0.0);
  today.model().set_past_models(0, memory);
  EXPECT_EQ(today.drive(1.0, 1200), (std::vector<std::int64_t>{1}));
  ASSERT_EQ(today.model().past_models(0).size(), 1U);
  EXPECT_GT(today.model().past_models(0)[0].info.samples, memory[0].info.samples);
}

TEST(StoredPastModel, WhereThereIsLessRoomTheLatestSamplesStay) {
  Trial trial(0.0);
  trial.drive(1.0, 1500);
  const StoredPastModel model = trial.model().past_models(0).front();
  const DynamicsAxis& axis = trial.model().mechanisms(0).dynamics_axis();
  OnlineSvrSettings small = axis.svr().champion().settings();
  small.buffer = 20;
  ASSERT_NE(axis.scaling(), nullptr);
  const PastModel past =
      in_learner_units(model, *axis.scaling(), axis.terms(), OnlineSvr(2, small));
  ASSERT_EQ(past.size(), 20U);
  std::vector<double> times = model.times_s;
  std::ranges::sort(times);
  EXPECT_EQ(past.times_s.front(), times[times.size() - 20]);
  EXPECT_EQ(past.times_s[19], times.back());
}

}  // namespace
}  // namespace kelpie::stored_past_model_test
