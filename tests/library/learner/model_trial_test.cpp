// SPDX-License-Identifier: Apache-2.0
#include "learner/model_trial.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "kelpie/svr/online_svr.hpp"
#include "learner/streams.hpp"

namespace kelpie::model_trial_test {
namespace {

using testing::respond;
using testing::Sample;
using testing::settings_for_plants;
using testing::wandering_stream;

// What a learner knows after it was shown plants 0 and 1, one past model each.
std::vector<PastModel> two_plants() {
  std::vector<PastModel> models;
  for (const int plant : {0, 1}) {
    OnlineSvr learner(2, settings_for_plants());
    for (const Sample& sample : wandering_stream(3, 1000, 0.02, plant)) {
      learner.update(sample.z, sample.y, sample.t);
    }
    const SampleCollector& buffer = learner.buffer();
    models.emplace_back(buffer.kernel(), buffer.samples().capacity());
    models.back().keep(buffer, learner.model(), {.number = plant + 1, .usual_error = 0.1});
  }
  return models;
}

TEST(ModelTrial, TheModelOfTheVehicleFitsAfterAFewSamples) {
  const std::vector<PastModel> models = two_plants();
  for (const std::size_t plant : {0U, 1U}) {
    ModelTrial trial(2, models.size());
    std::size_t shown = 0;
    for (const Sample& sample : wandering_stream(7, 50, 0.02, static_cast<int>(plant))) {
      if (trial.fitting({})) {
        break;
      }
      trial.add(sample.z, sample.y, 1.0, models);
      ++shown;
    }
    EXPECT_EQ(trial.fitting({}), std::optional(plant));
    EXPECT_GE(shown, 4U);
  }
}

TEST(ModelTrial, AnUnknownVehicleFitsNone) {
  const std::vector<PastModel> models = two_plants();
  ModelTrial trial(2, models.size());
  for (const Sample& sample : wandering_stream(7, 200, 0.02, 2)) {
    trial.add(sample.z, sample.y, 0.2, models);  // the model in service learns it
    EXPECT_FALSE(trial.fitting({}));
  }
}

TEST(ModelTrial, OneThatIsNoBetterThanTheModelInServiceDoesNotFit) {
  const std::vector<PastModel> models = two_plants();
  ModelTrial trial(2, models.size());
  for (const Sample& sample : wandering_stream(7, 200, 0.02, 0)) {
    trial.add(sample.z, sample.y, 0.02, models);
    EXPECT_FALSE(trial.fitting({}));
  }
}

TEST(ModelTrial, AVehicleAtRestMakesItsCaseOnce) {
  const std::vector<PastModel> models = two_plants();
  ModelTrial trial(2, models.size());
  const std::array place{0.3, -0.2};
  for (int i = 0; i < 200; ++i) {
    trial.add(place, respond(0, place[0], place[1]), 1.0, models);
  }
  EXPECT_FALSE(trial.fitting({}));
}

}  // namespace
}  // namespace kelpie::model_trial_test
