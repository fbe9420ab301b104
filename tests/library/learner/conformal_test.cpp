// SPDX-License-Identifier: Apache-2.0
#include "learner/conformal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <vector>

#include "kelpie/core/random.hpp"

namespace kelpie::conformal_test {
namespace {

// All its memory is in the object: there is nothing to allocate.
static_assert(std::is_trivially_copyable_v<ConformalInterval>);

struct Kept {
  double share = 0.0;
  double lowest = 1.0;  // in any 500 errors in a row
};

Kept kept(double coverage, const std::vector<double>& errors) {
  ConformalInterval interval(coverage);
  std::vector<std::size_t> held{0};
  for (const double error : errors) {
    if (std::isfinite(interval.half_width())) {
      held.push_back(held.back() + (error <= interval.half_width() ? 1 : 0));
    }
    interval.observe(error);
  }
  Kept result{static_cast<double>(held.back()) / static_cast<double>(held.size() - 1)};
  for (std::size_t i = 500; i < held.size(); ++i) {
    result.lowest = std::min(result.lowest, static_cast<double>(held[i] - held[i - 500]) / 500.0);
  }
  return result;
}

// Noise that swells and ebbs, grows for good, and jumps to five times its size and back.
std::vector<double> drifting_errors(std::uint64_t seed, std::size_t count) {
  RandomStream random(seed, "drift");
  std::vector<double> errors;
  for (std::size_t i = 0; i < count; ++i) {
    const auto t = static_cast<double>(i);
    const double swell = 1.0 + 0.7 * std::sin(t / 150.0);
    const double jump = (i / 1500) % 2 == 1 ? 5.0 : 1.0;
    errors.push_back(std::abs(random.normal()) * swell * jump * (1.0 + t / 3000.0));
  }
  return errors;
}

// A fair coin of 6,000 tosses would be within 0.012 of 0.9 in 99.7 % of all runs, and of 500 within
// 0.04; half as much again is allowed for in windows, since there are thousands of them.
TEST(ConformalInterval, KeepsItsPromiseWhileTheErrorsDrift) {
  for (const double coverage : {0.8, 0.9, 0.95}) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      const Kept found = kept(coverage, drifting_errors(seed, 6000));
      EXPECT_NEAR(found.share, coverage, 0.012);
      EXPECT_GT(found.lowest, coverage - 0.06);
    }
  }
}

// The same stream with a quantile of all errors so far, the plain method, doesn't keep it.
TEST(ConformalInterval, ThePlainQuantileWouldNot) {
  const std::vector<double> errors = drifting_errors(1, 6000);
  std::vector<double> sorted;
  double lowest = 1.0;
  std::vector<std::size_t> held{0};
  for (const double error : errors) {
    if (sorted.size() >= 30) {
      const double half = sorted[sorted.size() * 9 / 10];
      held.push_back(held.back() + (error <= half ? 1 : 0));
    }
    sorted.insert(std::ranges::upper_bound(sorted, error), error);
  }
  for (std::size_t i = 500; i < held.size(); ++i) {
    lowest = std::min(lowest, static_cast<double>(held[i] - held[i - 500]) / 500.0);
  }
  EXPECT_LT(lowest, 0.75);
}

TEST(ConformalInterval, FollowsTheUnitOfTheErrors) {
  ConformalInterval metres(0.9);
  ConformalInterval millimetres(0.9);
  for (const double error : drifting_errors(4, 1000)) {
    metres.observe(error);
    millimetres.observe(1024.0 * error);  // a power of two: to the last bit
    EXPECT_EQ(millimetres.half_width(), 1024.0 * metres.half_width());
  }
}

TEST(ConformalInterval, IsAnErrorOfTheLast250AndWidensWithThePromise) {
  ConformalInterval narrow(0.8);
  ConformalInterval wide(0.95);
  const std::vector<double> errors = drifting_errors(5, 1200);
  double mean_narrow = 0.0;
  double mean_wide = 0.0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    narrow.observe(errors[i]);
    wide.observe(errors[i]);
    if (i >= 250) {
      const auto end = errors.begin() + static_cast<std::ptrdiff_t>(i) + 1;
      EXPECT_NE(std::find(end - 250, end, narrow.half_width()), end);
      mean_narrow += narrow.half_width();
      mean_wide += wide.half_width();
    }
  }
  EXPECT_LT(mean_narrow, 0.8 * mean_wide);
}

TEST(ConformalInterval, PromisesNothingBeforeItKnowsEnough) {
  for (const double coverage : {0.5, 0.9, 0.99}) {
    ConformalInterval interval(coverage);
    for (std::size_t i = 0; i < interval.least(); ++i) {
      EXPECT_EQ(interval.half_width(), std::numeric_limits<double>::infinity());
      interval.observe(1.0 + static_cast<double>(i));
    }
    EXPECT_TRUE(std::isfinite(interval.half_width()));
  }
}

TEST(ConformalInterval, SurvivesErrorsThatAreNoneAllAlikeOrNoNumbers) {
  ConformalInterval zero(0.9);
  ConformalInterval alike(0.9);
  ConformalInterval broken(0.9);
  ConformalInterval clean(0.9);
  for (const double error : drifting_errors(6, 800)) {
    zero.observe(0.0);
    alike.observe(3.0);
    clean.observe(error);
    broken.observe(std::numeric_limits<double>::quiet_NaN());
    broken.observe(error);
    EXPECT_EQ(broken.half_width(), clean.half_width());
  }
  EXPECT_EQ(zero.half_width(), 0.0);
  EXPECT_EQ(alike.half_width(), 3.0);
}

// Ever growing errors miss any interval made of those before: the promise can't be kept, but the
// width has to follow, and come down again.
TEST(ConformalInterval, ComesBackAfterErrorsThatNothingCouldFollow) {
  ConformalInterval interval(0.9);
  for (int i = 0; i < 500; ++i) {
    interval.observe(std::pow(1.05, i));
    interval.observe(std::pow(1.05, i));
  }
  EXPECT_GE(interval.half_width(), 0.9 * std::pow(1.05, 490));
  RandomStream random(1, "after");
  for (int i = 0; i < 600; ++i) {
    interval.observe(std::abs(random.normal()));
  }
  EXPECT_NEAR(interval.half_width(), 1.64, 0.8);
}

}  // namespace
}  // namespace kelpie::conformal_test
