// SPDX-License-Identifier: Apache-2.0
#include "model/scale_tracker.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "kelpie/core/random.hpp"
#include "kelpie/motion/term_set.hpp"

namespace kelpie::scale_tracker_test {
namespace {

SharedSettings settings(double track = 2.0) {
  SharedSettings shared;
  shared.track = track;
  return shared;
}

TermSet terms() {
  return TermSet::from("a*b", std::vector<std::string>{"a", "b"}, 1);
}

ScaleTracker tracker(double track = 2.0) {
  return {2, settings(track), terms(), std::nullopt};
}

class ScaleTrackerTest : public ::testing::Test {
 protected:
  // Inputs of standard deviations `size` and 100 `size`, a target of 0.1 `size` around 5.
  void observe(ScaleTracker& scale, int samples, double size, bool second_moves = true) {
    for (int i = 0; i < samples; ++i) {
      const double second = second_moves ? 100.0 * size * random_.normal() : 7.0;
      scale.observe(std::array{size * random_.normal(), second},
                    5.0 + 0.1 * size * random_.normal());
    }
  }

  static void adopt_next(ScaleTracker& scale) {
    ASSERT_NE(scale.next(), nullptr);
    scale.adopt();
  }

  // How many of the next samples would have it go over to another scale.
  int count_changes(ScaleTracker& scale, int samples, double size) {
    int found = 0;
    for (int i = 0; i < samples; ++i) {
      observe(scale, 1, size);
      found += scale.next() != nullptr ? 1 : 0;
    }
    return found;
  }

 private:
  RandomStream random_{3, "scale"};
};

TEST_F(ScaleTrackerTest, MeasuresWhatItSees) {
  ScaleTracker scale = tracker();
  observe(scale, 2000, 1.0);
  const AxisScaling* const found = scale.next();
  ASSERT_NE(found, nullptr);
  EXPECT_NEAR(found->target.mean, 5.0, 0.01);
  EXPECT_NEAR(found->target.scale, 0.1, 0.01);
  EXPECT_NEAR(found->input.whitening(0, 0), 1.0, 0.1);
  EXPECT_NEAR(found->input.whitening(1, 1), 0.01, 0.001);
  EXPECT_EQ(scale.scaling(), nullptr);  // before it is adopted
}

TEST_F(ScaleTrackerTest, LeavesOutAnInputUntilItMoves) {
  ScaleTracker scale = tracker();
  observe(scale, 100, 1.0, false);
  adopt_next(scale);
  EXPECT_EQ(scale.scaling()->input.whitening(1, 1), 0.0);
  EXPECT_EQ(scale.scaling()->input.apply(std::array{0.5, 7.0})[1], 0.0);
  EXPECT_EQ(scale.scaling()->input.invert(std::array{0.5, 0.0})[1], 7.0);
  EXPECT_GT(count_changes(scale, 64, 1.0), 0);
}

TEST_F(ScaleTrackerTest, AbsurdSamplesAreNotBelieved) {
  ScaleTracker scale = tracker();
  observe(scale, 200, 1.0);
  adopt_next(scale);
  const std::array usual{0.3, -40.0};
  for (const double absurd : {-999.0, 1e5, 3e38}) {
    EXPECT_FALSE(scale.plausible(std::array{absurd, 0.0}, 5.0));
    EXPECT_FALSE(scale.plausible(usual, absurd));
    for (int i = 0; i < 5; ++i) {
      EXPECT_TRUE(scale.plausible(usual, 5.02));
    }
  }
}

// Gravity with two dropouts: a target of exactly 0 is as far away as any other.
TEST_F(ScaleTrackerTest, ADropoutOfTheTargetToZeroIsNotBelieved) {
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

// Its standard deviation says nothing of its next step.
TEST_F(ScaleTrackerTest, ACommandThatWasHeldMayMove) {
  ScaleTracker scale = tracker();
  for (int i = 0; i < 200; ++i) {
    scale.observe(std::array{0.1 * std::sin(0.3 * i), 40.0 + 1e-3 * std::cos(0.7 * i)},
                  std::sin(0.1 * i));
  }
  adopt_next(scale);
  EXPECT_TRUE(scale.plausible(std::array{0.0, -100.0}, 0.5));
  EXPECT_TRUE(scale.far(std::array{0.0, -100.0}));
  for (int i = 0; i < 20; ++i) {  // garbage does not widen what is plausible
    EXPECT_FALSE(scale.plausible(std::array{0.0, 125.0}, 0.5));
    scale.observe(std::array{0.0, 110.0}, 0.5);
  }
}

TEST_F(ScaleTrackerTest, ALightenedPastLetsNewSamplesSetTheScale) {
  ScaleTracker scale = tracker();
  observe(scale, 20'000, 1e-3);
  adopt_next(scale);
  scale.lighten(100);
  observe(scale, 100, 1.0);
  adopt_next(scale);
  EXPECT_LT(scale.scaling()->input.whitening(0, 0), 2.0);  // it was 1,000
}

TEST_F(ScaleTrackerTest, IsOutgrownByTheRatioThatIsTracked) {
  ScaleTracker scale = tracker();
  observe(scale, 200, 1.0);
  adopt_next(scale);
  EXPECT_EQ(count_changes(scale, 640, 1.3), 0);
  EXPECT_GT(count_changes(scale, 640, 10.0), 0);
}

TEST_F(ScaleTrackerTest, WithoutTrackingOrWhereItIsGivenTheScaleStays) {
  ScaleTracker first = tracker(0.0);
  observe(first, 200, 1.0);
  adopt_next(first);
  ScaleTracker given(2, settings(), terms(), *first.scaling());
  EXPECT_EQ(count_changes(first, 640, 10.0), 0);
  EXPECT_EQ(count_changes(given, 640, 10.0), 0);
}

TEST_F(ScaleTrackerTest, MapsASampleFromOneScaleToAnother) {
  ScaleTracker scale = tracker();
  observe(scale, 200, 1.0);
  adopt_next(scale);
  observe(scale, 3 * 640 - 200, 10.0);
  const AxisScaling* const found = scale.next();
  ASSERT_NE(found, nullptr);
  const AxisScaling& next = *found;
  const std::array x{0.3, -40.0};
  ScaledSample mapped = scale_sample(*scale.scaling(), scale.terms(), x);
  double y = scale.scaling()->target.apply(5.2);
  scale.set_out();
  scale.map()(mapped, y);
  const ScaledSample direct = scale_sample(next, scale.terms(), x);
  for (std::size_t k = 0; k < direct.size(); ++k) {
    EXPECT_NEAR(mapped[k], direct[k], 1e-12);
  }
  EXPECT_NEAR(y, next.target.apply(5.2), 1e-12);
}

// Also of the scale that is on the way, so that samples are mapped as before.
TEST_F(ScaleTrackerTest, AnAmplifiedInputIsScaledAsTheInputTimesTheFactor) {
  ScaleTracker scale = tracker();
  observe(scale, 200, 1.0);
  adopt_next(scale);
  observe(scale, 3 * 640 - 200, 10.0);
  ASSERT_NE(scale.next(), nullptr);
  scale.set_out();
  const AxisScaling before = *scale.scaling();
  const ScaledSample of_twice = scale_sample(before, scale.terms(), std::array{0.6, -40.0});
  ScaledSample mapped = of_twice;
  double y = 0.1;
  scale.map()(mapped, y);
  scale.amplify({.input = 0, .factor = 2.0});
  const ScaledSample now = scale_sample(*scale.scaling(), scale.terms(), std::array{0.3, -40.0});
  ScaledSample mapped_now = now;
  scale.map()(mapped_now, y);
  for (std::size_t k = 0; k < now.size(); ++k) {
    EXPECT_NEAR(now[k], of_twice[k], 1e-12);
    EXPECT_NEAR(mapped_now[k], mapped[k], 1e-12);
  }
}

// Until it has arrived: what was measured on the way is looked at then.
TEST_F(ScaleTrackerTest, OnTheWayToAScaleItLooksForNoOther) {
  ScaleTracker scale = tracker();
  observe(scale, 200, 1.0);
  adopt_next(scale);
  const AxisScaling first = *scale.scaling();
  observe(scale, 3 * 640 - 200, 10.0);
  ASSERT_NE(scale.next(), nullptr);
  scale.set_out();
  const ScaledSample z = scale_sample(first, scale.terms(), std::array{0.3, -40.0});
  ScaledSample before = z;
  double y = 0.5;
  scale.map()(before, y);
  EXPECT_EQ(count_changes(scale, 640, 100.0), 0);
  EXPECT_EQ(scale.scaling()->target.scale, first.target.scale);
  scale.adopt();
  EXPECT_EQ(scale.before()->target.scale, first.target.scale);
  EXPECT_EQ(count_changes(scale, 640, 100.0), 0);
  ScaledSample after = z;
  y = 0.5;
  scale.map()(after, y);  // still from the one to the other
  EXPECT_TRUE(std::ranges::equal(after, before));
  scale.arrive();
  EXPECT_EQ(scale.before(), nullptr);
  EXPECT_GT(count_changes(scale, 640, 100.0), 0);
}

}  // namespace
}  // namespace kelpie::scale_tracker_test
