// SPDX-License-Identifier: Apache-2.0
#include "learner/term_change.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "allocation_count.hpp"
#include "learner/adaptive_svr.hpp"
#include "learner/streams.hpp"

namespace kelpie::term_change_test {
namespace {

using testing::r_squared_on;
using testing::Sample;
using testing::wandering_stream;

constexpr std::array<double, 3> kStep{0.6, -0.3, 0.2};
const SampleMap kOther = [](std::span<double> z, double& y) {
  z[0] = 3.0 * z[0] - 1.0;
  z[1] = 0.5 * z[1] + 2.0;
  z[2] *= 4.0;
  z[3] *= 0.25;
  y = 2.0 * y - 7.0;
};

// The inputs themselves are the terms; the step makes the changed vehicle.
std::vector<Sample> with_terms(std::vector<Sample> stream, bool changed) {
  for (Sample& sample : stream) {
    sample.z.insert(sample.z.end(), {sample.z[0], sample.z[1]});
    if (changed) {
      sample.y += kStep[0] * sample.z[2] + kStep[1] * sample.z[3] + kStep[2];
    }
  }
  return stream;
}

OnlineSvrSettings settings() {
  OnlineSvrSettings settings = testing::settings_for_plants();
  settings.lambda = 0.1;
  return settings;
}

AdaptiveSvr learned(std::size_t samples) {
  AdaptiveSvr learner(2, settings(), 2);
  for (const Sample& sample : with_terms(wandering_stream(1, samples), false)) {
    learner.update(sample.z, sample.y, sample.t);
  }
  return learner;
}

TEST(TermChange, IsTheSameChangeInAnotherScale) {
  TermChange change(2, 2);
  const std::vector<double> z{0.4, -0.7, 1.5, 2.5};
  EXPECT_EQ(change(z), 0.0);
  change.add(kStep);
  const double before = change(z);
  EXPECT_NEAR(before, 0.6 * 1.5 - 0.3 * 2.5 + 0.2, 1e-12);
  std::vector<double> scratch(4);
  change.rescale(kOther, scratch);
  std::vector<double> other = z;
  double y = 0.0;
  kOther(other, y);
  EXPECT_NEAR(change(other), 2.0 * before, 1e-12);
  change.clear();
  EXPECT_EQ(change(other), 0.0);
}

TEST(ShiftedSvr, KnowsTheChangedVehicleAtOnceAndGoesOnLearning) {
  AdaptiveSvr learner = learned(1200);
  const std::vector<Sample> judged = with_terms(wandering_stream(77, 500, 0.0), true);
  EXPECT_LT(r_squared_on(learner, judged), 0.8);
  const std::size_t before = testing::allocations;
  learner.shift(kStep, {.changed = true, .changed_since = 300.0});
  EXPECT_EQ(testing::allocations, before);
  EXPECT_GT(r_squared_on(learner, judged), 0.97);
  for (const Sample& sample : with_terms(wandering_stream(5, 1500, 0.02, 0, 300.0), true)) {
    EXPECT_FALSE(learner.update(sample.z, sample.y, sample.t).changed) << sample.t;
  }
  EXPECT_GT(r_squared_on(learner, judged), 0.97);
  EXPECT_EQ(learner.status().tally.changes, 1);
}

TEST(ShiftedSvr, KeepsTheChangeInAnotherScale) {
  AdaptiveSvr learner = learned(600);
  learner.shift(kStep, {.changed = true, .changed_since = 150.0});
  std::vector<Sample> judged = with_terms(wandering_stream(77, 300, 0.0), true);
  testing::go_over(learner, kOther);
  for (Sample& sample : judged) {
    kOther(sample.z, sample.y);
  }
  EXPECT_GT(r_squared_on(learner, judged), 0.95);
}

// Past models are of the vehicles themselves: the vehicle before the change, and after.
TEST(ShiftedSvr, KeepsPastModelsOfBothVehicles) {
  AdaptiveSvr learner = learned(1200);
  learner.shift(kStep, {.changed = true, .changed_since = 300.0});
  for (const Sample& sample : with_terms(wandering_stream(5, 800, 0.02, 0, 300.0), true)) {
    learner.update(sample.z, sample.y, sample.t);
  }
  ASSERT_EQ(learner.past_models().models().size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    const PastModel& past = learner.past_models().models()[k];
    double error = 0.0;
    double target_error = 0.0;
    std::vector<double> z(4);
    for (std::size_t i = 0; i < past.size(); ++i) {
      past.samples.get(i, z);
      const double truth = testing::respond(0, z[0], z[1]) +
                           (k == 1 ? kStep[0] * z[2] + kStep[1] * z[3] + kStep[2] : 0.0);
      error += std::abs(past.function(z) - truth) / static_cast<double>(past.size());
      target_error += std::abs(past.targets[i] - truth) / static_cast<double>(past.size());
    }
    EXPECT_LT(error, 0.1) << k;
    EXPECT_LT(target_error, 0.05) << k;
  }
}

TEST(ShiftedSvr, TakesBackWhatIsWithdrawn) {
  AdaptiveSvr learner = learned(1200);
  const std::vector<Sample> judged = with_terms(wandering_stream(77, 500, 0.0), false);
  const double before = r_squared_on(learner, judged);
  learner.shift(kStep, {.changed = true, .changed_since = 300.0});
  const std::array<double, 3> back{-kStep[0], -kStep[1], -kStep[2]};
  learner.shift(back, {.withdrawn = true});
  EXPECT_NEAR(r_squared_on(learner, judged), before, 1e-12);
  EXPECT_EQ(learner.status().tally.withdrawn, 1);
}

}  // namespace
}  // namespace kelpie::term_change_test
