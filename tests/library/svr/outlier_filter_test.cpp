// SPDX-License-Identifier: Apache-2.0
#include "svr/outlier_filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "kelpie/svr/online_svr.hpp"
#include "learner/streams.hpp"

namespace kelpie::outlier_filter_test {
namespace {

using testing::Sample;
using testing::wandering_stream;

OnlineSvrSettings settings(OutlierRule rule) {
  OnlineSvrSettings values;
  values.buffer = 300;
  values.gamma = 0.5;
  values.epsilon = 0.1;
  values.outlier = rule;
  return values;
}

// Spikes of ±5 standard deviations on every 37th sample.
std::set<std::size_t> add_spikes(std::vector<Sample>& stream) {
  std::set<std::size_t> spiked;
  for (std::size_t i = 100; i < stream.size(); i += 37) {
    stream[i].y += i % 2 == 0 ? 5.0 : -5.0;
    spiked.insert(i);
  }
  return spiked;
}

std::size_t spikes_in(const OnlineSvr& learner, const std::vector<Sample>& stream,
                      const std::set<std::size_t>& spiked) {
  std::size_t count = 0;
  for (const std::size_t i : spiked) {
    const auto targets = learner.buffer().problem().targets();
    count += std::ranges::find(targets, stream[i].y) != targets.end() ? 1 : 0;
  }
  return count;
}

OnlineSvr learned(const std::vector<Sample>& stream, OutlierRule rule) {
  OnlineSvr learner(2, settings(rule));
  for (const Sample& sample : stream) {
    learner.update(sample.z, sample.y, sample.t);
  }
  return learner;
}

TEST(OutlierFilter, RobustRuleRemovesSpikes) {
  std::vector<Sample> stream = wandering_stream(41, 2000);
  const std::set<std::size_t> spiked = add_spikes(stream);
  const std::size_t kept_by_robust =
      spikes_in(learned(stream, OutlierRule::robust), stream, spiked);
  const std::size_t kept_by_none = spikes_in(learned(stream, OutlierRule::none), stream, spiked);
  EXPECT_LE(kept_by_robust, spiked.size() / 20);
  EXPECT_GE(kept_by_none, spiked.size() / 4);  // the test would be empty otherwise
}

TEST(OutlierFilter, RobustRuleLeavesCleanDataAlone) {
  for (const double noise : {0.02, 0.15}) {
    const std::vector<Sample> stream = wandering_stream(42, 2000, noise);
    const OnlineSvr learner = learned(stream, OutlierRule::robust);
    EXPECT_LE(learner.status().tally.outliers, learner.status().tally.accepted / 100) << noise;
  }
}

TEST(OutlierFilter, RobustRuleDoesNotTakeANewVehicleForOutliers) {
  std::vector<Sample> stream = wandering_stream(43, 1500);
  const std::vector<Sample> changed = wandering_stream(44, 1000, 0.02, 1, 375.0);
  stream.insert(stream.end(), changed.begin(), changed.end());
  const OnlineSvr learner = learned(stream, OutlierRule::robust);
  double error = 0.0;
  for (const Sample& sample : wandering_stream(45, 300, 0.0, 1)) {
    error += std::abs(learner.predict(sample.z) - sample.y) / 300.0;
  }
  const OnlineSvr without = learned(stream, OutlierRule::none);
  double error_without = 0.0;
  for (const Sample& sample : wandering_stream(45, 300, 0.0, 1)) {
    error_without += std::abs(without.predict(sample.z) - sample.y) / 300.0;
  }
  EXPECT_LT(error, 1.1 * error_without);
}

// The trap of eq. (12): free support vectors have |e| = ε, so the quartiles are ±ε, the range ±4ε,
// and with a narrow tube every support vector at the bound is an outlier.
TEST(OutlierFilter, QuartileRuleTakesBoundedSupportVectorsOfCleanData) {
  const auto outliers = [](OutlierRule rule) {
    OnlineSvrSettings narrow = settings(rule);
    narrow.epsilon = 0.005;
    narrow.c = 0.3;
    OnlineSvr learner(2, narrow);
    for (const Sample& sample : wandering_stream(46, 1000, 0.05)) {
      learner.update(sample.z, sample.y, sample.t);
    }
    return learner.status().tally.outliers;
  };
  EXPECT_GT(outliers(OutlierRule::iqr), 100);
  EXPECT_LT(outliers(OutlierRule::robust), 10);
}

}  // namespace
}  // namespace kelpie::outlier_filter_test
