// SPDX-License-Identifier: Apache-2.0
#include "lab/sparse_online_svr.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "kelpie/core/error.hpp"
#include "learner/streams.hpp"
#include "study/metrics.hpp"
#include "support.hpp"

namespace kelpie::sparse_online_svr_test {
namespace {

using testing::r_squared_on;
using testing::Sample;
using testing::wandering_stream;

lab::SparseOnlineSvrSettings small() {
  lab::SparseOnlineSvrSettings settings;
  settings.dictionary = 60;
  settings.gamma = 0.5;
  settings.epsilon = 0.02;
  settings.threshold = 1e-4;
  return settings;
}

RC_GTEST_PROP(SparseOnlineSvr, EveryUpdateKeepsItsPromises, ()) {
  lab::SparseOnlineSvrSettings settings;
  settings.dictionary = *rc::gen::inRange(2, 50);
  settings.threshold = *rc::gen::element(0.0, 1e-4, 1e-2);
  settings.fade_s = *rc::gen::element(0.5, 10.0, 1e9);
  settings.epsilon = *rc::gen::element(0.0, 0.05, 0.3);
  settings.c = *rc::gen::element(0.1, 10.0);
  settings.gamma = *rc::gen::element(0.01, 0.3, 3.0);
  const auto seed = *rc::gen::inRange<std::uint64_t>(0, 1000);
  const auto repeat = *rc::gen::inRange<std::size_t>(1, 4);  // duplicated points
  lab::SparseOnlineSvr learner(2, settings);
  for (const Sample& sample : wandering_stream(seed, 120, 0.3)) {
    for (std::size_t copy = 0; copy < repeat; ++copy) {
      const double before = learner.predict(sample.z);
      const Decision decision = learner.update(sample.z, sample.y, sample.t);
      const Status status = learner.status();
      RC_ASSERT(decision.prediction.value == before);
      RC_ASSERT(status.buffer <= settings.dictionary);
      RC_ASSERT(status.tally.accepted == status.buffer + status.tally.forgotten);
      RC_ASSERT(status.kkt_gap <= settings.tolerance);
      RC_ASSERT(kkt_afresh(learner.problem()).gap() <= settings.tolerance + 1e-9);
      RC_ASSERT(learner.inverse().size() == learner.dictionary().size());
    }
  }
}

TEST(SparseOnlineSvr, LearnsASmoothFunction) {
  lab::SparseOnlineSvr learner(2, small());
  for (const Sample& sample : wandering_stream(1, 3000)) {
    learner.update(sample.z, sample.y, sample.t);
  }
  EXPECT_GT(r_squared_on(learner, wandering_stream(2, 1000, 0.0)), 0.98);
}

TEST(SparseOnlineSvr, AdaptsAfterASwitchBecauseOldSamplesFade) {
  lab::SparseOnlineSvrSettings settings = small();
  settings.dictionary = 25;  // smaller than the number of independent samples: who's in can fade
  settings.threshold = 1e-6;
  settings.fade_s = 50.0;
  lab::SparseOnlineSvr fading(2, settings);
  settings.fade_s = 1e9;
  lab::SparseOnlineSvr keeping(2, settings);
  std::vector<Sample> stream = wandering_stream(3, 2000);
  const std::vector<Sample> after = wandering_stream(4, 2000, 0.02, 1, stream.back().t);
  stream.insert(stream.end(), after.begin(), after.end());
  for (const Sample& sample : stream) {
    fading.update(sample.z, sample.y, sample.t);
    keeping.update(sample.z, sample.y, sample.t);
  }
  const std::vector<Sample> held_out = wandering_stream(5, 1000, 0.0, 1);
  EXPECT_GT(r_squared_on(fading, held_out), 0.9);
  EXPECT_LT(r_squared_on(keeping, held_out), 0.5);
}

TEST(SparseOnlineSvr, ADuplicateDoesNotEnter) {
  lab::SparseOnlineSvr learner(2, small());
  const std::vector<double> here{0.1, 0.2};
  EXPECT_EQ(learner.update(here, 1.0, 0.0).verdict, Verdict::accepted);
  EXPECT_EQ(learner.update(here, -1.0, 1.0).verdict, Verdict::explained);
  EXPECT_EQ(learner.status().buffer, 1);
}

// The one that leaves is the least independent, not merely the oldest.
TEST(SparseOnlineSvr, TheSampleThatOthersReplaceBestLeaves) {
  lab::SparseOnlineSvrSettings settings = small();
  settings.dictionary = 3;
  settings.fade_s = 1e9;
  lab::SparseOnlineSvr learner(1, settings);
  double t = 0.0;
  for (const double z : {-5.0, 0.0, 0.3, 5.0}) {
    learner.update({&z, 1}, z, t++);
  }
  std::vector<double> kept(learner.dictionary().coordinate(0).begin(),
                           learner.dictionary().coordinate(0).end());
  std::ranges::sort(kept);
  ASSERT_EQ(kept.size(), 3U);
  EXPECT_EQ(kept.front(), -5.0);
  EXPECT_EQ(kept.back(), 5.0);
}

TEST(SparseOnlineSvr, ABadSampleIsTurnedAwayAndChangesNothing) {
  lab::SparseOnlineSvr learner(2, small());
  for (const Sample& sample : wandering_stream(6, 50)) {
    learner.update(sample.z, sample.y, sample.t);
  }
  const std::vector<double> here{0.1, 0.2};
  const double before = learner.predict(here);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(learner.update(std::vector{nan, 0.0}, 0.0, 99.0).verdict, Verdict::invalid);
  EXPECT_EQ(learner.update(here, nan, 99.0).verdict, Verdict::invalid);
  EXPECT_EQ(learner.update(here, 0.0, nan).verdict, Verdict::invalid);
  EXPECT_EQ(learner.update(std::vector{1.0}, 0.0, 99.0).verdict, Verdict::invalid);
  EXPECT_EQ(learner.status().tally.invalid, 4);
  EXPECT_EQ(learner.predict(here), before);
}

TEST(SparseOnlineSvr, SettingsOutOfRangeAreNamed) {
  lab::SparseOnlineSvrSettings settings;
  settings.threshold = -1.0;
  const auto make = [&] { return lab::SparseOnlineSvr(2, settings); };
  EXPECT_EQ(testing::message_of<InputError>(make),
            "threshold: -1 is out of range; it has to be 0 to 1");
}

}  // namespace
}  // namespace kelpie::sparse_online_svr_test
