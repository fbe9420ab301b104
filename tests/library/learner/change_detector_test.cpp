// SPDX-License-Identifier: Apache-2.0
#include "learner/change_detector.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

#include "kelpie/core/random.hpp"

namespace kelpie::change_detector_test {
namespace {

constexpr double kUsual = 0.1;

// Shows samples with Gaussian errors until the detector has come to a verdict; who is tried has a
// model at once. Returns the last thing said that is not `none`.
Suspicion show(ChangeDetector& detector, RandomStream& random, int samples, double champion,
               double challenger, double& t) {
  Suspicion last = Suspicion::none;
  for (int i = 0; i < samples && last <= Suspicion::raised; ++i) {
    const std::optional<double> other =
        detector.trying() ? std::optional(challenger * random.normal()) : std::nullopt;
    const Suspicion said = detector.inspect(
        {.champion = champion * random.normal(), .challenger = other}, kUsual, t += 0.25);
    last = said == Suspicion::none ? last : said;
  }
  return last;
}

TEST(ChangeDetector, UsualErrorsRaiseNothing) {
  ChangeDetector detector;
  RandomStream random(1, "usual");
  double t = 0.0;
  EXPECT_EQ(show(detector, random, 100'000, kUsual, 0.0, t), Suspicion::none);
}

TEST(ChangeDetector, OutliersRaiseNothing) {
  ChangeDetector detector;
  RandomStream random(2, "outliers");
  for (int i = 0; i < 50'000; ++i) {
    const double error = i % 20 == 0 ? 1000.0 : std::abs(kUsual * random.normal());
    ASSERT_EQ(detector.inspect({.champion = error}, kUsual, i), Suspicion::none) << i;
  }
}

TEST(ChangeDetector, AChallengerThatIsBetterByFarConfirmsAChangeAndItsTime) {
  ChangeDetector detector;
  RandomStream random(3, "change");
  double t = 0.0;
  ASSERT_EQ(show(detector, random, 1000, kUsual, 0.0, t), Suspicion::none);
  const double changed = t;
  EXPECT_EQ(show(detector, random, 100, 6.0 * kUsual, kUsual, t), Suspicion::confirmed);
  EXPECT_NEAR(detector.since(), changed, 10 * 0.25);
}

// New ground: errors grow, and somebody without a past fares no better.
TEST(ChangeDetector, AChallengerThatIsNoBetterIsDismissed) {
  ChangeDetector detector;
  RandomStream random(4, "ground");
  double t = 0.0;
  EXPECT_EQ(show(detector, random, 200, 6.0 * kUsual, 6.0 * kUsual, t), Suspicion::dismissed);
  EXPECT_FALSE(detector.trying());
}

// A lead that one lucky stretch gives is no lead: it has to be more than half an error per sample.
TEST(ChangeDetector, ASmallLeadDoesNotCount) {
  ChangeDetector detector;
  double t = 0.0;
  while (!detector.trying()) {
    detector.inspect({.champion = 10 * kUsual}, kUsual, t += 0.25);
  }
  Suspicion said = Suspicion::none;
  for (int i = 0; i < 600 && said == Suspicion::none; ++i) {
    said = detector.inspect({.champion = 1.4 * kUsual, .challenger = kUsual}, kUsual, t += 0.25);
  }
  EXPECT_EQ(said, Suspicion::dismissed);
}

// New ground that a straight line foretells, and a kernel that has to grow there does not.
TEST(ChangeDetector, WhatOthersForetellIsNoChange) {
  ChangeDetector detector;
  double t = 0.0;
  Suspicion said = Suspicion::none;
  for (int i = 0; i < 1000 && said <= Suspicion::raised; ++i) {
    const std::optional<double> challenger =
        detector.trying() ? std::optional(kUsual) : std::nullopt;
    const double champion = (i % 2 == 0 ? 10 : -10) * kUsual;
    said = detector.inspect({.champion = champion, .challenger = challenger, .all = kUsual}, kUsual,
                            t += 0.25);
  }
  EXPECT_EQ(said, Suspicion::dismissed);
}

// A cable that pulls, or a sensor with an offset: the model plus a number is right again.
TEST(ChangeDetector, AnOffsetIsNoChange) {
  ChangeDetector detector;
  RandomStream random(10, "offset");
  double t = 0.0;
  Suspicion said = Suspicion::none;
  for (int i = 0; i < 1000 && said <= Suspicion::raised; ++i) {
    const std::optional<double> challenger =
        detector.trying() ? std::optional(kUsual * random.normal()) : std::nullopt;
    said =
        detector.inspect({.champion = kUsual * (6.0 + random.normal()), .challenger = challenger},
                         kUsual, t += 0.25);
  }
  EXPECT_EQ(said, Suspicion::dismissed);
}

// Its first samples are no judgement on a challenger, and one that never gets a model loses.
TEST(ChangeDetector, AChallengerWithoutAModelLoses) {
  ChangeDetector detector;
  double t = 0.0;
  Suspicion said = Suspicion::none;
  for (int i = 0; i < 600 && said != Suspicion::dismissed; ++i) {
    said = detector.inspect({.champion = 10 * kUsual}, kUsual, t += 0.25);
    ASSERT_NE(said, Suspicion::confirmed);
  }
  EXPECT_EQ(said, Suspicion::dismissed);
}

// Thrusters and loads act on several axes.
TEST(ChangeDetector, WhereAChangeIsExpectedHalfOfTheLeadIsEnough) {
  const auto samples_until_confirmed = [](bool expected) {
    ChangeDetector detector;
    RandomStream random(8, "expected");
    double t = 0.0;
    show(detector, random, 1000, kUsual, 0.0, t);
    int samples = 0;
    Suspicion said = Suspicion::none;
    for (; said != Suspicion::confirmed && samples < 500; ++samples) {
      said = show(detector, random, 1, 4.0 * kUsual, kUsual, t);
      if (expected) {
        detector.expect_change();
      }
    }
    return samples;
  };
  EXPECT_LT(samples_until_confirmed(true), samples_until_confirmed(false) - 10);
  ChangeDetector calm;
  RandomStream random(9, "calm");
  double t = 0.0;
  calm.expect_change();  // raises nothing by itself
  EXPECT_EQ(show(calm, random, 10'000, kUsual, 0.0, t), Suspicion::none);
}

// A challenger in service is on probation: the model before is compared with it.
TEST(ChangeDetector, AChangeIsWithdrawnWhenTheModelBeforeIsBetterByFar) {
  ChangeDetector detector;
  RandomStream random(5, "probation");
  double t = 0.0;
  detector.start_probation(kUsual);
  ASSERT_TRUE(detector.on_probation());
  EXPECT_EQ(show(detector, random, 300, kUsual, 3.0 * kUsual, t), Suspicion::none);
  EXPECT_EQ(show(detector, random, 100, 6.0 * kUsual, kUsual, t), Suspicion::withdrawn);
  EXPECT_FALSE(detector.trying());
}

TEST(ChangeDetector, AConfirmedChangeIsOnProbationForAWhile) {
  ChangeDetector detector;
  RandomStream random(6, "proof");
  double t = 0.0;
  ASSERT_EQ(show(detector, random, 200, 6.0 * kUsual, kUsual, t), Suspicion::confirmed);
  EXPECT_TRUE(detector.on_probation());
  EXPECT_EQ(show(detector, random, 1000, kUsual, 6.0 * kUsual, t), Suspicion::dismissed);
  EXPECT_FALSE(detector.trying());
}

TEST(ChangeDetector, WaitsUntilTheUsualErrorIsKnown) {
  ChangeDetector detector;
  for (int i = 0; i < 1000; ++i) {
    ASSERT_EQ(detector.inspect({.champion = 100.0}, std::numeric_limits<double>::infinity(), i),
              Suspicion::none);
  }
}

}  // namespace
}  // namespace kelpie::change_detector_test
