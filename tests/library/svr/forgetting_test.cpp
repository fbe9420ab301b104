// SPDX-License-Identifier: Apache-2.0
#include "svr/forgetting.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "kelpie/svr/online_svr.hpp"
#include "learner/streams.hpp"

namespace kelpie::forgetting_test {
namespace {

using testing::Sample;
using testing::wandering_stream;

OnlineSvrSettings settings(ForgetRule rule) {
  OnlineSvrSettings values;
  values.buffer = 2;
  values.forget = rule;
  values.k = 1.0;
  values.bandwidth = 0.5;
  return values;
}

// Three samples: two close together (0, 1), one apart (2), with given times.
SampleCollector three(ForgetRule rule, const std::vector<double>& times) {
  SampleCollector buffer(1, 0, settings(rule));
  const std::vector<double> places{0.0, 0.1, 5.0};
  for (std::size_t i = 0; i < 3; ++i) {
    buffer.compare({&places[i], 1});
    buffer.collect({&places[i], 1}, 0.0, times[i]);
  }
  return buffer;
}

TEST(Forgetting, FifoTakesTheOldestWhereverItLies) {
  const Forgetting fifo(settings(ForgetRule::fifo));
  EXPECT_EQ(fifo.forgotten(three(ForgetRule::fifo, {3.0, 1.0, 2.0}), 4.0), 0U);  // by arrival
}

TEST(Forgetting, DensePlacesLoseFirstAndTheOlderOfThemAtThat) {
  for (const ForgetRule rule : {ForgetRule::paper, ForgetRule::age}) {
    const Forgetting forgetting(settings(rule));
    EXPECT_EQ(forgetting.forgotten(three(rule, {10.0, 40.0, 20.0}), 50.0), 0U);
    EXPECT_EQ(forgetting.forgotten(three(rule, {40.0, 10.0, 20.0}), 50.0), 1U);
  }
}

TEST(Forgetting, OnTrueAgeAVeryOldLonerGoesBeforeFreshNeighbours) {
  const Forgetting age(settings(ForgetRule::age));
  EXPECT_EQ(age.forgotten(three(ForgetRule::age, {900.0, 901.0, 0.0}), 901.0), 2U);
}

// A sample of later than now, as a candidate has that learns samples kept, has no age; NaN would
// make this sample leave, whatever its place.
TEST(Forgetting, ASampleOfLaterThanNowIsNew) {
  const Forgetting age(settings(ForgetRule::age));
  EXPECT_EQ(age.forgotten(three(ForgetRule::age, {60.0, 10.0, 20.0}), 50.0), 1U);
}

// With Unix time stamps eq. (7) has no sense of age left; the true age has no clock to depend on.
TEST(Forgetting, TrueAgeDoesNotDependOnTheClocksZero) {
  const auto model_after = [](ForgetRule rule, double start_s) {
    OnlineSvrSettings values;
    values.buffer = 40;
    values.gamma = 0.5;
    values.forget = rule;
    OnlineSvr learner(2, values);
    for (const Sample& sample : wandering_stream(51, 600, 0.02, 0, start_s)) {
      learner.update(sample.z, sample.y, sample.t);
    }
    return learner.predict(std::vector{0.4, -0.3});
  };
  EXPECT_EQ(model_after(ForgetRule::age, 0.0), model_after(ForgetRule::age, 1'700'000'000.0));
  EXPECT_NE(model_after(ForgetRule::paper, 0.0), model_after(ForgetRule::paper, 1'700'000'000.0));
}

TEST(Forgetting, NobodyLeavesABufferThatHasRoom) {
  OnlineSvrSettings values = settings(ForgetRule::age);
  values.buffer = 3;
  EXPECT_FALSE(Forgetting(values).forgotten(three(ForgetRule::age, {0.0, 1.0, 2.0}), 3.0));
}

TEST(Forgetting, ReleasesTheIdleSampleInTheDensestPlace) {
  OnlineSvrSettings values = settings(ForgetRule::age);
  values.anchors = 2;
  const auto released = Forgetting(values).released(three(ForgetRule::age, {0.0, 1.0, 2.0}));
  ASSERT_TRUE(released.has_value());
  EXPECT_NE(*released, 2U);
  values.anchors = 3;
  EXPECT_FALSE(Forgetting(values).released(three(ForgetRule::age, {0.0, 1.0, 2.0})));
}

}  // namespace
}  // namespace kelpie::forgetting_test
