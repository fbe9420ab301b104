// SPDX-License-Identifier: Apache-2.0
#include "model/first_scale.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "kelpie/core/random.hpp"
#include "kelpie/motion/term_set.hpp"
#include "kelpie/svr/online_svr.hpp"

namespace kelpie::first_scale_test {
namespace {

class FirstScaleTest : public ::testing::Test {
 protected:
  static FirstScale scale(std::optional<AxisScaling> given = {}) {
    SharedSettings settings;
    settings.warmup = 200;
    return {2, settings, TermSet::from("a*b", std::vector<std::string>{"a", "b"}, 1),
            std::move(given)};
  }

  // Inputs of standard deviations 1 and 100, a target of 0.1 around 5.
  void learn(FirstScale& scale, int samples, double size = 1.0, bool second_moves = true) {
    for (int i = 0; i < samples; ++i) {
      const double second = second_moves ? 100.0 * size * random_.normal() : 7.0;
      scale.update(learner_, std::array{size * random_.normal(), second},
                   5.0 + 0.1 * size * random_.normal(), 0.1 * i);
    }
  }

  OnlineSvr learner_{2, OnlineSvrSettings{}, 1};

 private:
  RandomStream random_{3, "scale"};
};

TEST_F(FirstScaleTest, MeasuresTheFirstSamplesAndStays) {
  FirstScale scale = FirstScaleTest::scale();
  learn(scale, 199);
  EXPECT_EQ(scale.scaling(), nullptr);
  EXPECT_NEAR(scale.predict(learner_, std::array{0.0, 0.0}), 5.0, 0.05);
  learn(scale, 1);
  ASSERT_NE(scale.scaling(), nullptr);
  EXPECT_NEAR(scale.scaling()->target.mean, 5.0, 0.05);
  EXPECT_NEAR(scale.scaling()->target.scale, 0.1, 0.02);
  EXPECT_NEAR(scale.scaling()->input.whitening(0, 0), 1.0, 0.2);
  EXPECT_NEAR(scale.scaling()->input.whitening(1, 1), 0.01, 0.002);
  const double first = scale.scaling()->target.scale;
  learn(scale, 100, 10.0);
  EXPECT_EQ(scale.scaling()->target.scale, first);
}

TEST_F(FirstScaleTest, LeavesOutAConstantInput) {
  FirstScale scale = FirstScaleTest::scale();
  learn(scale, 200, 1.0, false);
  ASSERT_NE(scale.scaling(), nullptr);
  EXPECT_EQ(scale.scaling()->input.whitening(1, 1), 0.0);
  EXPECT_EQ(scale.scaling()->input.apply(std::array{0.5, 7.0})[1], 0.0);
  EXPECT_EQ(scale.scaling()->input.invert(std::array{0.5, 0.0})[1], 7.0);
}

TEST_F(FirstScaleTest, AGivenScaleIsUsedAtOnce) {
  FirstScale first = scale();
  learn(first, 200);
  FirstScale given = scale(*first.scaling());
  OnlineSvr fresh{2, OnlineSvrSettings{}, 1};
  EXPECT_EQ(given.update(fresh, std::array{0.1, 2.0}, 5.0, 0.0).verdict, Verdict::accepted);
}

// Gravity with two dropouts: a target of exactly 0 is as far away as any other.
TEST_F(FirstScaleTest, ADropoutOfTheTargetToZeroIsNotBelieved) {
  RandomStream random(4, "dropout");
  WarmUp first(1, 50);
  for (int i = 0; i < 50; ++i) {
    const double y = i == 10 || i == 30 ? 0.0 : 9.8 + 0.01 * random.normal();
    first.hold(std::array{random.normal()}, y, 0.1 * i);
  }
  const std::vector<bool> plausible = plausible_samples(first, 1);
  EXPECT_FALSE(plausible[10]);
  EXPECT_FALSE(plausible[30]);
  EXPECT_GT(std::ranges::count(plausible, true), 40);
}

}  // namespace
}  // namespace kelpie::first_scale_test
