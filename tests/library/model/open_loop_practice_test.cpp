// SPDX-License-Identifier: Apache-2.0
#include "model/open_loop_practice.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "allocation_count.hpp"
#include "kelpie/core/random.hpp"

namespace kelpie::open_loop_practice_test {
namespace {

constexpr double kStep = 0.5;
constexpr int kSteps = 120;  // of a stretch
constexpr std::array<Extremes, 2> kSeen{Extremes{-100.0, 100.0}, Extremes{-100.0, 100.0}};

// A vehicle whose acceleration is its command, with a velocity that is measured exactly.
class Drive {
 public:
  // Goes through stretches with two models that are off by constant accelerations.
  void stretches(int count, double a_off, double b_off) {
    for (int i = 0; i < count; ++i) {
      practice.begin(sample());
      for (int step = 0; step < kSteps; ++step) {
        time_s_ += kStep;
        practice.go_on(sample(), kStep, off_by(a_off), off_by(b_off), kSeen);
      }
      EXPECT_FALSE(practice.running());
    }
  }

  std::array<double, 2> sample() const {
    return {3.0 * std::sin(0.2 * time_s_), 0.6 * std::cos(0.2 * time_s_)};
  }
  static Accelerations off_by(double off) {
    return [off](std::span<const double> x, std::span<double> a) { a[0] = x[1] + off; };
  }

  OpenLoopPractice practice{2, {0}};

 private:
  double time_s_ = 0.0;
};

TEST(OpenLoopPractice, KnowsNothingAtFirst) {
  const OpenLoopPractice practice(2, {0});
  EXPECT_EQ(practice.share(0), 0.5);
  EXPECT_EQ(practice.kept(0), (ByAge{1.0, 1.0, 1.0, 1.0}));
  EXPECT_TRUE(std::isnan(practice.off(0)[0]));
}

TEST(OpenLoopPractice, BelievesInTheModelThatIsRightAndInItsChange) {
  Drive a_right;
  a_right.stretches(12, 0.0, 0.02);
  EXPECT_GT(a_right.practice.share(0), 0.9);
  Drive b_right;
  b_right.stretches(12, 0.02, 0.0);
  EXPECT_LT(b_right.practice.share(0), 0.1);
  for (const double kept : b_right.practice.kept(0)) {
    EXPECT_GT(kept, 0.95);
  }
}

// Errors to either side: the mixture is better than both.
TEST(OpenLoopPractice, MixesModelsWhoseErrorsAreOpposite) {
  Drive drive;
  drive.stretches(12, 0.03, -0.01);
  EXPECT_NEAR(drive.practice.share(0), 0.25, 0.05);
  EXPECT_LT(drive.practice.off(0)[3], 0.25 * 0.01 * 60.0);
}

TEST(OpenLoopPractice, HoldsTheVelocityWhereNoModelIsBetter) {
  OpenLoopPractice practice(2, {0});
  RandomStream random(1, "held");
  const Accelerations model = [](std::span<const double> x, std::span<double> a) { a[0] = x[1]; };
  for (int i = 0; i < 24; ++i) {
    const double push = random.normal();  // that the vehicle doesn't heed
    practice.begin(std::array{1.0, push});
    for (int step = 0; step < kSteps; ++step) {
      practice.go_on(std::array{1.0 + 0.01 * random.normal(), push}, kStep, model, model, kSeen);
    }
  }
  for (const double kept : practice.kept(0)) {
    EXPECT_LT(kept, 0.2);
  }
}

TEST(OpenLoopPractice, ForgetsWhatAYoungModelDid) {
  Drive drive;
  drive.stretches(10, 0.02, 1.0);
  EXPECT_GT(drive.practice.share(0), 0.8);
  drive.stretches(24, 0.02, 0.0);
  EXPECT_LT(drive.practice.share(0), 0.1);
}

TEST(OpenLoopPractice, AfterAChangeOfTheVehicleAFewStretchesCountOn) {
  Drive drive;
  drive.stretches(24, 0.0, 0.02);
  drive.practice.restart();
  EXPECT_GT(drive.practice.share(0), 0.7);
  drive.stretches(12, 0.02, 0.0);
  EXPECT_LT(drive.practice.share(0), 0.35);
}

// The spread holds nine of ten errors, whatever their size.
TEST(OpenLoopPractice, TellsTheSpreadOfErrors) {
  for (const double size : {3e-3, 1e-2}) {
    int within = 0;
    int all = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      RandomStream random(seed, "spread");
      Drive drive;
      for (int i = 0; i < 24; ++i) {
        const double off = size * random.normal();
        drive.stretches(1, off, off);
      }
      const double spread = drive.practice.off(0)[3];
      for (int i = 0; i < 100; ++i, ++all) {
        within += std::abs(60.0 * size * random.normal()) <= 1.645 * spread ? 1 : 0;
      }
    }
    EXPECT_GT(within, 0.85 * all);
    EXPECT_LT(within, 0.97 * all);
  }
}

TEST(OpenLoopPractice, AnInterruptedStretchIsNotScoredAndNothingAllocates) {
  Drive drive;
  drive.stretches(1, 0.0, 0.0);
  const Accelerations a = Drive::off_by(0.0);
  OpenLoopPractice practice(2, {0});
  const std::size_t before = testing::allocations;
  practice.begin(drive.sample());
  practice.go_on(drive.sample(), kStep, a, a, kSeen);
  practice.break_off();
  EXPECT_FALSE(practice.running());
  EXPECT_EQ(testing::allocations, before);
  EXPECT_TRUE(std::isnan(practice.off(0)[0]));
}

}  // namespace
}  // namespace kelpie::open_loop_practice_test
