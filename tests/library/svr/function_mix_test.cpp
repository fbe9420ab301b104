// SPDX-License-Identifier: Apache-2.0
#include "svr/function_mix.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "kelpie/core/random.hpp"

namespace kelpie::function_mix_test {
namespace {

SvrFunction random_function(RandomStream& random, double gamma, double bias) {
  SampleStore centres(2, 10);
  std::vector<double> beta;
  for (int i = 0; i < 10; ++i) {
    centres.push_back(std::vector{random.normal(), random.normal()});
    beta.push_back(random.normal());
  }
  SvrFunction function({gamma, {.fine = 0.3}, 2, 1}, 10);
  function.assign(centres, beta, std::array{random.normal()}, bias);
  return function;
}

FunctionMix three(double third_bias) {
  RandomStream random(4, "mix");
  FunctionMix mix;
  mix.members.push_back({"a", 0.5, random_function(random, 0.2, 0.1)});
  mix.members.push_back({"b", 0.3, random_function(random, 0.7, -0.2)});
  mix.members.push_back({"c", 0.2, random_function(random, 0.4, third_bias)});
  return mix;
}

TEST(FunctionMix, IsTheWeighedMeanOfWhatItsMembersSay) {
  const FunctionMix mix = three(0.0);
  const std::array x{0.3, -0.8, 1.2};
  double sum = 0.0;
  for (const FunctionMix::Member& member : mix.members) {
    sum += member.share * member.function(x);
  }
  EXPECT_DOUBLE_EQ(mix(x), sum);
}

// A member gone wild moves the sum by its share of the limits, and no more.
TEST(FunctionMix, NoMemberSaysMoreThanItsBounds) {
  FunctionMix wild = three(1e9);
  wild.limits = {.low = -2.0, .high = 3.0};
  const std::array x{0.3, -0.8, 1.2};
  const auto bounded = [&](std::size_t k) {
    return std::clamp(wild.members[k].function(x), -2.0, 3.0);
  };
  EXPECT_DOUBLE_EQ(wild(x), 0.5 * bounded(0) + 0.3 * bounded(1) + 0.2 * 3.0);
}

// James & Stein: the estimate of a mean that is uncertain lies between the mean and the simplest
// function, nearer to the latter the more the functions disagree.
TEST(FunctionMix, DisagreementShrinksTheMeanTowardsTheLastFunction) {
  const std::array x{0.3, -0.8, 1.2};
  FunctionMix mix = three(0.0);
  const double mean = mix(x);
  const double last = mix.members[2].function(x);
  double distance = std::abs(mean - last);
  for (const double caution : {0.1, 1.0, 10.0}) {
    mix.limits.caution = caution;
    EXPECT_LT(std::abs(mix(x) - last), distance);
    EXPECT_GT((mix(x) - last) * (mean - last), 0.0);
    distance = std::abs(mix(x) - last);
  }
  mix.members[1].function = mix.members[0].function;
  EXPECT_NEAR(mix(x), 0.8 * mix.members[0].function(x) + 0.2 * last, 1e-12) << "no disagreement";
}

TEST(FunctionMix, ALoneFunctionIsItself) {
  FunctionMix mix = three(0.0);
  mix.members.erase(mix.members.begin() + 1, mix.members.end());
  mix.members[0].share = 1.0;
  mix.limits.caution = 1.0;
  const std::array x{0.3, -0.8, 1.2};
  EXPECT_DOUBLE_EQ(mix(x), mix.members[0].function(x));
}

TEST(FunctionMix, TheGradientIsThatOfFiniteDifferencesInsideAndBeyondTheLimits) {
  for (const auto& [third, caution] :
       {std::pair{0.0, 0.0}, {1e9, 0.0}, {0.0, 1.0}, {1e9, 1.0}, {-2.0, 5.0}}) {
    FunctionMix mix = three(third);
    mix.limits = {.low = -20.0, .high = 20.0, .caution = caution};
    const std::array x{0.3, -0.8, 1.2};
    std::array<double, 3> gradient{};
    EXPECT_NEAR(mix.with_gradient(x, gradient), mix(x), 1e-12);
    for (std::size_t k = 0; k < 3; ++k) {
      constexpr double kStep = 1e-6;
      std::array above = x;
      std::array below = x;
      above[k] += kStep;
      below[k] -= kStep;
      EXPECT_NEAR(gradient[k], (mix(above) - mix(below)) / (2.0 * kStep), 1e-6) << k;
    }
  }
}

// A square through the samples says nothing of places far away.
TEST(FunctionMix, BeyondItsRangeATermStaysAndHasNoSlope) {
  FunctionMix mix = three(0.0);
  const std::array edge{0.3, -0.8, 1.2};
  const std::array beyond{0.3, -0.8, 40.0};
  const double at_edge = mix(edge);
  mix.term_ranges = {{.low = -1.0, .high = 1.2}};
  EXPECT_DOUBLE_EQ(mix(edge), at_edge);
  EXPECT_DOUBLE_EQ(mix(beyond), at_edge);
  std::array<double, 3> gradient{};
  EXPECT_NEAR(mix.with_gradient(beyond, gradient), at_edge, 1e-12);
  EXPECT_EQ(gradient[2], 0.0);
  EXPECT_NE(gradient[0], 0.0);
}

}  // namespace
}  // namespace kelpie::function_mix_test
