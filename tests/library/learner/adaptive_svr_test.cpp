// SPDX-License-Identifier: Apache-2.0
#include "learner/adaptive_svr.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "kelpie/core/error.hpp"
#include "learner/streams.hpp"

namespace kelpie::adaptive_svr_test {
namespace {

using testing::r_squared_on;
using testing::Sample;
using testing::settings_for_plants;
using testing::wandering_stream;

std::vector<Sample> changing_stream(std::uint64_t seed, std::size_t samples) {
  std::vector<Sample> stream = wandering_stream(seed, samples);
  const std::vector<Sample> after = wandering_stream(seed + 1, samples, 0.02, 1, stream.back().t);
  stream.insert(stream.end(), after.begin(), after.end());
  return stream;
}

TEST(AdaptiveSvr, NoticesAnotherVehicleAndLearnsItAtOnce) {
  const std::vector<Sample> stream = changing_stream(1, 1000);
  AdaptiveSvr adaptive(2, settings_for_plants());
  OnlineSvrSettings fifo = settings_for_plants();
  fifo.adapt = AdaptRule::none;
  fifo.forget = ForgetRule::fifo;
  AdaptiveSvr forgetting(2, fifo);
  double changed_at = 0.0;
  double since = 0.0;
  for (std::size_t i = 0; i < 1200; ++i) {
    const Decision decision = adaptive.update(stream[i].z, stream[i].y, stream[i].t);
    if (decision.changed) {
      changed_at = stream[i].t;
      since = decision.changed_since;
    }
    forgetting.update(stream[i].z, stream[i].y, stream[i].t);
  }
  const std::vector<Sample> judged = wandering_stream(77, 500, 0.0, 1);
  EXPECT_EQ(adaptive.status().tally.changes, 1);
  EXPECT_LT(changed_at - stream[999].t, 0.25 * 150);  // within 150 samples
  EXPECT_NEAR(since, stream[999].t, 0.25 * 20);
  EXPECT_GT(r_squared_on(adaptive, judged), 0.97);
  EXPECT_LT(r_squared_on(forgetting, judged), 0.9);
}

TEST(AdaptiveSvr, TheSameVehicleRaisesNoFalseAlarm) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
    AdaptiveSvr learner(2, settings_for_plants());
    for (const Sample& sample : wandering_stream(seed, 2000, 0.1)) {
      ASSERT_FALSE(learner.update(sample.z, sample.y, sample.t).changed) << seed;
    }
  }
}

// New ground: first slow, then ten times as wide. Errors grow, the vehicle is the same.
TEST(AdaptiveSvr, NewGroundIsNoChange) {
  AdaptiveSvr learner(2, settings_for_plants());
  std::vector<Sample> stream = wandering_stream(3, 3000);
  std::int64_t changes = 0;
  for (std::size_t i = 0; i < stream.size(); ++i) {
    const double range = i < 1000 ? 0.2 : 2.0;
    const double a = range * stream[i].z[0];
    const double b = range * stream[i].z[1];
    const Decision decision =
        learner.update(std::vector{a, b}, a + 0.3 * b * std::abs(b), stream[i].t);
    changes += decision.changed ? 1 : 0;
  }
  EXPECT_EQ(changes, 0);
}

TEST(AdaptiveSvr, WithoutAChallengerItIsTheChampionToTheLastBit) {
  OnlineSvrSettings settings = settings_for_plants();
  settings.adapt = AdaptRule::none;
  AdaptiveSvr adaptive(2, settings);
  OnlineSvr plain(2, settings);
  for (const Sample& sample : changing_stream(5, 400)) {
    const Decision a = adaptive.update(sample.z, sample.y, sample.t);
    const Decision b = plain.update(sample.z, sample.y, sample.t);
    ASSERT_EQ(a.verdict, b.verdict);
    ASSERT_EQ(a.prediction.value, b.prediction.value);
    ASSERT_EQ(adaptive.predict(sample.z), plain.predict(sample.z));
  }
  EXPECT_EQ(adaptive.status().tally.accepted, plain.status().tally.accepted);
}

// Another vehicle, and the first again: that one's model may bring more samples than there were.
TEST(AdaptiveSvr, EverySampleIsAccountedForAndNoTotalGoesDown) {
  std::vector<Sample> stream = changing_stream(9, 800);
  const std::vector<Sample> back = wandering_stream(11, 400, 0.02, 0, stream.back().t);
  stream.insert(stream.end(), back.begin(), back.end());
  AdaptiveSvr learner(2, settings_for_plants());
  Tally before;
  for (const Sample& sample : stream) {
    learner.update(sample.z, sample.y, sample.t);
    const Status status = learner.status();
    const Tally& tally = status.tally;
    ASSERT_EQ(tally.accepted + tally.regained,
              status.buffer + tally.outliers + tally.forgotten + tally.released);
    for (const TallyField& field : tally_fields()) {
      ASSERT_GE(tally.*field.total, before.*field.total) << field.key;
    }
    before = tally;
  }
  EXPECT_EQ(before.changes, 2);
  EXPECT_EQ(before.recalls, 1);
  EXPECT_GE(before.suspicions, 1);
}

TEST(AdaptiveSvr, AClearedLearnerIsANewOne) {
  const std::vector<Sample> stream = changing_stream(13, 300);
  OnlineSvr used(2, settings_for_plants());
  for (const Sample& sample : stream) {
    used.update(sample.z, sample.y, sample.t);
  }
  used.clear();
  OnlineSvr fresh(2, settings_for_plants());
  for (const Sample& sample : stream) {
    ASSERT_EQ(used.predict(sample.z), fresh.predict(sample.z));
    used.update(sample.z, sample.y, sample.t);
    fresh.update(sample.z, sample.y, sample.t);
  }
  EXPECT_EQ(used.status().tally.accepted, fresh.status().tally.accepted);
}

// A sample in another scale, and the map to it.
const SampleMap kOther = [](std::span<double> x, double& y) {
  x[0] = 0.5 * x[0] + 0.2;
  x[1] *= 0.7;
  y = 0.5 * y - 1.0;
};

std::vector<Sample> in_other_scale(std::vector<Sample> stream) {
  for (Sample& sample : stream) {
    kOther(sample.z, sample.y);
  }
  return stream;
}

// A learner on its way to another scale, to which samples come as they are.
class Traveller {
 public:
  explicit Traveller(const OnlineSvrSettings& settings) : learner(2, settings) {}

  Decision show(const Sample& sample) {
    last = on_the_way ? learner.rescale(kOther) : last;
    arrived = arrived || last == RescaleStatus::switched;
    on_the_way = on_the_way && last != RescaleStatus::done;
    Sample own = sample;
    if (arrived) {
      kOther(own.z, own.y);
    }
    return learner.update(own.z, own.y, own.t);
  }

  AdaptiveSvr learner;
  bool on_the_way = false;
  bool arrived = false;
  RescaleStatus last = RescaleStatus::done;
};

TEST(AdaptiveSvr, GoesOverToAnotherScaleWhileTheModelBeforeServes) {
  for (const SolverKind solver : {SolverKind::path, SolverKind::smo}) {
    OnlineSvrSettings settings = settings_for_plants();
    settings.solver = solver;
    Traveller traveller(settings);
    const std::vector<Sample> stream = wandering_stream(21, 1600);
    const std::vector<Sample> judged = wandering_stream(22, 300, 0.0);
    const std::vector<Sample> judged_after = in_other_scale(judged);
    int updates = 0;
    for (std::size_t i = 0; i < stream.size(); ++i) {
      traveller.on_the_way = traveller.on_the_way || i == 800;
      traveller.show(stream[i]);
      const AdaptiveSvr& learner = traveller.learner;
      if (i >= 800) {
        updates += traveller.arrived ? 0 : 1;
        ASSERT_GT(r_squared_on(learner, traveller.arrived ? judged_after : judged), 0.98) << i;
        ASSERT_LE(kkt_afresh(learner.champion().buffer().problem()).gap(), settings.tolerance);
      }
      const Status status = learner.status();
      ASSERT_EQ(
          status.tally.accepted + status.tally.regained,
          status.buffer + status.tally.outliers + status.tally.forgotten + status.tally.released);
    }
    EXPECT_GT(updates, 1);
    EXPECT_LT(updates, 200);
    EXPECT_FALSE(traveller.on_the_way);
    EXPECT_EQ(traveller.learner.status().tally.changes, 0);
  }
}

// When the samples came that a learner has and that aren't older than `since`.
std::set<double> times_since(double since, const AdaptiveSvr& learner) {
  const SampleCollector& buffer = learner.champion().buffer();
  std::set<double> times;
  for (std::size_t k = 0; k < buffer.size(); ++k) {
    if (buffer.time(k) >= since) {
      times.insert(buffer.time(k));
    }
  }
  return times;
}

// What comes while the samples of before are learned again isn't lost. There is noise, so
// that every sample tells something. (In the other scale some are explained by others,
// and which is a matter of rounding.)
TEST(AdaptiveSvr, HasLearnedInTheOtherScaleWhatCameOnTheWay) {
  Traveller traveller(settings_for_plants());
  for (const Sample& sample : wandering_stream(23, 600)) {
    traveller.show(sample);
  }
  const double begun = 150.0;
  const std::vector<Sample> stream = wandering_stream(24, 300, 0.3, 0, begun);
  std::set<double> came;
  for (std::size_t i = 0; i < stream.size() && !traveller.arrived; ++i) {
    came = times_since(begun, traveller.learner);
    traveller.on_the_way = true;
    traveller.show(stream[i]);
  }
  ASSERT_TRUE(traveller.arrived);
  ASSERT_GT(came.size(), 3U);
  const std::set<double> known = times_since(begun, traveller.learner);
  const auto lost = std::ranges::count_if(came, [&](double t) { return !known.contains(t); });
  EXPECT_LT(2 * lost, std::ssize(came)) << lost << " of " << came.size();
}

// The way is gone to its end; then the change is found.
TEST(AdaptiveSvr, AChangeOnTheWayToAnotherScaleIsFoundAfterwards) {
  Traveller traveller(settings_for_plants());
  const std::vector<Sample> stream = changing_stream(25, 1000);
  int way = 0;
  std::size_t found = 0;
  for (std::size_t i = 0; i < stream.size() && found == 0; ++i) {
    traveller.on_the_way = traveller.on_the_way || i == 995;
    const bool changed = traveller.show(stream[i]).changed;
    way += traveller.on_the_way ? 1 : 0;
    EXPECT_FALSE(changed && traveller.on_the_way);
    found = changed ? i : 0;
  }
  EXPECT_GT(way, 5);
  EXPECT_GT(found, 1000U);
  EXPECT_LT(found, 1250U);
}

// The vehicle returns on the way to another scale: its model is taken up there.
TEST(AdaptiveSvr, AReturnOnTheWayToAnotherScaleIsFoundAfterwards) {
  Traveller traveller(settings_for_plants());
  double time = 0.0;
  int recalls = 0;
  const auto drive = [&](std::uint64_t seed, int plant, std::size_t samples) {
    for (const Sample& sample : wandering_stream(seed, samples, 0.02, plant, time)) {
      const Decision decision = traveller.show(sample);
      recalls += decision.recalled > 0 ? 1 : 0;
      EXPECT_FALSE(decision.recalled > 0 && traveller.on_the_way);
      time = sample.t;
    }
  };
  drive(26, 0, 1000);
  drive(27, 1, 1000);
  traveller.on_the_way = true;
  drive(28, 1, 3);
  drive(29, 0, 500);
  EXPECT_TRUE(traveller.arrived);
  EXPECT_EQ(recalls, 1);
  EXPECT_GT(r_squared_on(traveller.learner, in_other_scale(wandering_stream(77, 500, 0.0))), 0.95);
}

TEST(AdaptiveSvr, RefusesWrongSettings) {
  OnlineSvrSettings settings;
  settings.c = -1.0;
  EXPECT_THROW(AdaptiveSvr(2, settings), InputError);
}

}  // namespace
}  // namespace kelpie::adaptive_svr_test
