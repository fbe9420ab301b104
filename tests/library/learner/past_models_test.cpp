// SPDX-License-Identifier: Apache-2.0
#include "learner/past_models.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "learner/adaptive_svr.hpp"
#include "learner/streams.hpp"
#include "saved_state.hpp"

namespace kelpie::past_models_test {
namespace {

using testing::r_squared_on;
using testing::respond;
using testing::Sample;
using testing::settings_for_plants;
using testing::wandering_stream;

// A learner that is shown one vehicle after the other.
class Voyage {
 public:
  explicit Voyage(const OnlineSvrSettings& settings = settings_for_plants())
      : learner_(2, settings) {}

  // Shows a vehicle; returns the past models taken up.
  std::vector<std::int64_t> drive(int plant, std::size_t samples) {
    std::vector<std::int64_t> recalled;
    for (const Sample& sample : wandering_stream(++seed_, samples, 0.02, plant, time_)) {
      const Decision decision = learner_.update(sample.z, sample.y, sample.t);
      time_ = sample.t;
      if (decision.recalled > 0) {
        recalled.push_back(decision.recalled);
        EXPECT_TRUE(decision.changed);
      }
    }
    return recalled;
  }

  double level(int plant) const {
    return r_squared_on(learner_, wandering_stream(77, 500, 0.0, plant));
  }

  AdaptiveSvr& learner() { return learner_; }
  std::span<const PastModel> models() const { return learner_.past_models().models(); }

 private:
  AdaptiveSvr learner_;
  std::uint64_t seed_ = 10;
  double time_ = 0.0;
};

TEST(PastModels, GoesFromStateToState) {
  using State = PastModels::State;
  Voyage voyage;
  const PastModels& memory = voyage.learner().past_models();
  EXPECT_EQ(memory.state(), State::settling);
  voyage.drive(0, 1000);
  EXPECT_EQ(memory.state(), State::watching);
  voyage.drive(1, 30);  // unknown: nothing fits
  EXPECT_EQ(memory.state(), State::on_trial);
  voyage.drive(1, 970);
  EXPECT_EQ(memory.state(), State::watching);
  voyage.drive(0, 50);  // recalled, and its usual error is known
  EXPECT_EQ(memory.state(), State::watching);
  voyage.learner().alert(0.0, false);  // too soon after a change
  EXPECT_EQ(memory.state(), State::watching);
  voyage.drive(0, 100);
  voyage.learner().alert(0.0, false);
  EXPECT_EQ(memory.state(), State::on_trial);
  testing::go_over(voyage.learner(), [](std::span<double>, double&) {});
  EXPECT_EQ(memory.state(), State::on_trial);
  voyage.drive(0, 200);  // none fits: it is the vehicle that it was
  EXPECT_EQ(memory.state(), State::settling);
}

// Errors that grow are no return: the picture of the model in service may fit ever so well.
TEST(PastModels, NothingIsRecalledThatHasNotLeft) {
  const OnlineSvrSettings settings = settings_for_plants();
  OnlineSvr service(2, settings);
  PastModels memory(service.buffer(), settings);
  double time = 0.0;
  const auto drive = [&](double error, int samples) {
    for (const Sample& sample : wandering_stream(3, static_cast<std::size_t>(samples))) {
      service.update(sample.z, sample.y, time += 0.25);
      memory.observe(sample.z, sample.y, error, time);
      if (memory.due()) {
        memory.keep(service, service.model(), TermChange(2, 0), time);
      }
      EXPECT_FALSE(memory.fitting());
    }
  };
  drive(0.05, 1000);
  ASSERT_EQ(memory.models().size(), 1U);
  drive(2.0, 100);
  EXPECT_EQ(memory.state(), PastModels::State::on_trial);
  drive(2.0, 2000);
  EXPECT_EQ(memory.models().size(), 1U);  // nor is the same vehicle kept twice
}

// The second vehicle has just come, and is told to be the first, which for a moment it seems to be.
TEST(PastModels, AWrongRecallIsTakenBack) {
  Voyage voyage;
  voyage.drive(0, 1000);
  voyage.drive(1, 300);
  ASSERT_EQ(voyage.learner().status().tally.changes, 1);
  voyage.learner().alert(0.25 * 1300, false);
  ASSERT_EQ(voyage.drive(0, 40), (std::vector<std::int64_t>{1}));
  EXPECT_TRUE(voyage.drive(1, 150).empty());
  EXPECT_EQ(voyage.learner().status().tally.withdrawn, 1);
  EXPECT_EQ(voyage.models()[0].info.recalls, 0);
  EXPECT_GT(voyage.level(1), 0.9);
  voyage.drive(1, 1000);
  EXPECT_EQ(voyage.models().size(), 2U);
}

// A copy made on probation has never been recalled; the state loads all the same.
TEST(PastModels, AChangeTakenBackAfterItsCopyLeavesASoundState) {
  const OnlineSvrSettings settings = settings_for_plants();
  OnlineSvr service(2, settings);
  PastModels memory(service.buffer(), settings);
  double time = 0.0;
  for (const Sample& sample : wandering_stream(3, 1000)) {
    service.update(sample.z, sample.y, time += 0.25);
    memory.observe(sample.z, sample.y, 0.05, time);
    if (time == 125.0) {
      memory.promote_challenger(time);
    }
    if (memory.due()) {
      memory.keep(service, service.model(), TermChange(2, 0), time);
    }
  }
  memory.withdraw();
  for (const PastModel& model : memory.models()) {
    EXPECT_GE(model.info.recalls, 0);
  }
}

// Two pictures of one vehicle, as two runs at once leave them.
TEST(PastModels, TwoModelsOfOneVehicleBecomeOne) {
  Voyage earlier;
  earlier.drive(0, 1500);
  PastModel twin = earlier.models().front();
  twin.info.earlier = twin.info.samples;
  Voyage voyage;
  ASSERT_TRUE(voyage.learner().add_past(twin));
  twin.info.number = 2;
  ASSERT_TRUE(voyage.learner().add_past(twin));
  voyage.drive(0, 3000);
  ASSERT_EQ(voyage.models().size(), 1U);
  EXPECT_EQ(voyage.models()[0].info.earlier, 2 * twin.info.samples);
}

TEST(PastModels, AWithdrawalFindsThePlaceOfTheFormerVehicleTaken) {
  OnlineSvrSettings settings = settings_for_plants();
  settings.memory = 1;
  OnlineSvr first(2, settings);
  OnlineSvr second(2, settings);
  PastModels memory(first.buffer(), settings);
  double time = 0.0;
  const auto drive = [&](OnlineSvr& service, int plant) {
    for (const Sample& sample : wandering_stream(3, 600, 0.02, plant)) {
      service.update(sample.z, sample.y, time += 0.25);
      memory.observe(sample.z, sample.y, 0.05, time);
      if (memory.due()) {
        memory.keep(service, service.model(), TermChange(2, 0), time);
      }
    }
  };
  drive(first, 0);
  memory.promote_challenger(time);
  drive(second, 1);
  const std::int64_t withdrawn = memory.models()[0].info.number;
  EXPECT_EQ(withdrawn, 2);
  memory.withdraw();
  drive(first, 0);
  EXPECT_NE(memory.models()[0].info.number, withdrawn) << "the other vehicle's number";
}

// A past model is given at once, whatever the budget of updates.
TEST(PastModels, AModelIsGivenUnderASpentBudget) {
  Voyage earlier;
  earlier.drive(0, 1500);
  Voyage voyage;
  voyage.learner().limit(Budget(0));
  ASSERT_TRUE(voyage.learner().add_past(earlier.models().front()));
  EXPECT_EQ(voyage.models().size(), 1U);
}

TEST(PastModels, KnowsEveryVehicleThatReturns) {
  Voyage voyage;
  voyage.drive(0, 1000);
  const double level_0 = voyage.level(0);
  EXPECT_TRUE(voyage.drive(1, 1000).empty());
  const double level_1 = voyage.level(1);
  EXPECT_EQ(voyage.drive(0, 50), (std::vector<std::int64_t>{1}));
  EXPECT_GT(voyage.level(0), level_0 - 0.02);
  EXPECT_TRUE(voyage.drive(0, 950).empty());
  EXPECT_TRUE(voyage.drive(2, 1000).empty());  // an unknown one is no known one
  EXPECT_EQ(voyage.drive(1, 50), (std::vector<std::int64_t>{2}));
  EXPECT_GT(voyage.level(1), level_1 - 0.02);
  EXPECT_TRUE(voyage.drive(1, 950).empty());
  EXPECT_EQ(voyage.learner().status().tally.recalls, 2);
  ASSERT_EQ(voyage.models().size(), 3U);
  EXPECT_EQ(voyage.models()[0].info.recalls, 1);
  EXPECT_EQ(voyage.models()[2].info.recalls, 0);
}

// What was learned after a return is not lost with the next change.
TEST(PastModels, APictureIsRenewedAfterAReturn) {
  Voyage voyage;
  voyage.drive(0, 1000);
  voyage.drive(1, 1000);
  voyage.drive(0, 1000);
  EXPECT_GT(voyage.models()[0].info.samples, 1800);
  EXPECT_GT(voyage.models()[0].info.until_s, 0.25 * 2800);
  EXPECT_LT(voyage.models()[0].info.from_s, 5.0);
}

TEST(PastModels, GradualDriftRecallsNothing) {
  AdaptiveSvr learner(2, settings_for_plants());
  const std::vector<Sample> places = wandering_stream(4, 8000, 0.0);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double a = places[i].z[0];
    const double b = places[i].z[1];
    const double share = std::clamp((static_cast<double>(i) - 1000.0) / 6000.0, 0.0, 1.0);
    const double y = (1.0 - share) * respond(0, a, b) + share * respond(1, a, b);
    ASSERT_EQ(learner.update(places[i].z, y, places[i].t).recalled, 0) << "sample " << i;
  }
  EXPECT_FALSE(learner.past_models().models().empty());  // else there is nothing to recall
}

TEST(PastModels, TheSameVehicleIsKeptOnce) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    AdaptiveSvr learner(2, settings_for_plants());
    for (const Sample& sample : wandering_stream(seed, 4000, 0.1)) {
      ASSERT_EQ(learner.update(sample.z, sample.y, sample.t).recalled, 0) << seed;
    }
    EXPECT_EQ(learner.past_models().models().size(), 1U) << seed;
  }
}

TEST(PastModels, WhenItIsFullTheLeastUsefulLeaves) {
  OnlineSvrSettings settings = settings_for_plants();
  settings.memory = 2;
  Voyage voyage(settings);
  voyage.drive(0, 1000);
  voyage.drive(1, 1000);
  voyage.drive(0, 1000);  // recalled once: the more useful one
  voyage.drive(2, 1000);
  ASSERT_EQ(voyage.models().size(), 2U);
  EXPECT_EQ(voyage.models()[0].info.number, 1);
  EXPECT_EQ(voyage.models()[1].info.number, 3);
  EXPECT_EQ(voyage.drive(0, 50), (std::vector<std::int64_t>{1}));
}

TEST(PastModels, WithoutRoomNothingIsKept) {
  OnlineSvrSettings settings = settings_for_plants();
  settings.memory = 0;
  Voyage voyage(settings);
  voyage.drive(0, 1000);
  voyage.drive(1, 1000);
  EXPECT_TRUE(voyage.drive(0, 500).empty());
  EXPECT_TRUE(voyage.models().empty());
}

// The model before predicts until the past one is ready; that takes more than one update.
TEST(PastModels, APastModelIsTakenUpWhileTheModelBeforeServes) {
  Voyage voyage;
  voyage.drive(0, 1000);
  voyage.drive(1, 1000);
  const OnlineSvr* const before = &std::as_const(voyage.learner()).champion();
  int on_the_way = 0;
  bool returning = false;
  for (const Sample& sample : wandering_stream(50, 60, 0.02, 0, 1000.0)) {
    const Decision decision = voyage.learner().update(sample.z, sample.y, sample.t);
    if (decision.recalled > 0) {
      break;
    }
    ASSERT_EQ(&std::as_const(voyage.learner()).champion(), before);
    ASSERT_NE(decision.verdict, Verdict::crowded_out);
    returning = returning || decision.returning;
    on_the_way += returning ? 1 : 0;
  }
  EXPECT_GT(on_the_way, 0);
  EXPECT_LT(on_the_way, 20);
  EXPECT_GT(voyage.level(0), 0.97);
}

// A past model survives a change of scale: its function is that of its samples in the new one.
TEST(PastModels, GoesOverToAnotherScale) {
  Voyage voyage;
  voyage.drive(0, 1000);
  voyage.drive(1, 1000);
  const double error = voyage.models()[0].info.usual_error;
  const SampleMap doubled = [](std::span<double>, double& y) { y = 2.0 * y + 1.0; };
  const SvrFunction before = voyage.models()[0].function;
  testing::go_over(voyage.learner(), doubled);
  EXPECT_NEAR(voyage.models()[0].info.usual_error, 2.0 * error, 1e-12);
  for (const Sample& sample : wandering_stream(5, 50, 0.0)) {
    EXPECT_NEAR(voyage.models()[0].function(sample.z), 2.0 * before(sample.z) + 1.0, 0.15);
  }
}

// A life with a return, put away and taken up again at every stage of it.
TEST(PastModels, GoesOnToTheLastBitAfterACheckpoint) {
  std::vector<Sample> life;
  for (const int plant : {0, 1, 0}) {
    const double start = life.empty() ? 0.0 : life.back().t;
    const std::vector<Sample> leg = wandering_stream(life.size() + 1, 700, 0.02, plant, start);
    life.insert(life.end(), leg.begin(), leg.end());
  }
  const AdaptiveSvr whole = testing::expect_same_life(
      [] { return AdaptiveSvr(2, settings_for_plants()); }, life.size(),
      [](std::size_t i) { return i % 100 == 50 || (i >= 1400 && i < 1450); },
      [&](AdaptiveSvr& learner, std::size_t i) {
        learner.update(life[i].z, life[i].y, life[i].t);
      });
  EXPECT_EQ(whole.status().tally.recalls, 1);
}

}  // namespace
}  // namespace kelpie::past_models_test
