// SPDX-License-Identifier: Apache-2.0
#include "model/work_limit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "kelpie/core/random.hpp"
#include "kelpie/model/dynamics_model.hpp"
#include "kelpie/svr/resources.hpp"

namespace kelpie::work_limit_test {
namespace {

TEST(WorkLimit, EveryAxisHasItsPartWhateverTheOthersTake) {
  WorkLimit limit(3, 901);
  const Work most = limit.most();
  for (std::size_t i = 0; i < 3; ++i) {
    Budget axis = limit.grant(Budget(), 2 - i);
    EXPECT_TRUE(axis.goes_on());
    Work taken = 0;
    for (; axis.spend(1000); taken += 1000) {
    }
    EXPECT_GE(taken + 1000, most / 6);
    EXPECT_LE(taken, most * 2 / 3 + 1000);
  }
  EXPECT_EQ(WorkLimit(2, 100).most(), most);
  EXPECT_EQ(WorkLimit(6, 901).most(), 2 * most);
  EXPECT_GT(WorkLimit(3, 1801).most(), 3 * most);
}

TEST(WorkLimit, GrowsWhereSamplesAreTurnedAwayAndShrinksAgain) {
  WorkLimit limit(3, 901);
  const Work least = limit.most();
  for (int i = 0; i < 600; ++i) {
    limit.learned(true);
  }
  EXPECT_GT(limit.most(), 5 * least);
  for (int i = 0; i < 10'000; ++i) {
    limit.learned(true);
  }
  EXPECT_LE(limit.most(), 20 * least);  // also as a forged state may claim
  for (int i = 0; i < 200'000; ++i) {
    limit.learned(false);
  }
  EXPECT_LT(limit.most() - least, least / 100);
}

// Samples far apart, hardly a tube and large weights: without a limit an update takes up to 201
// steps of the path.
TEST(WorkLimit, BoundsTheStepsOfAnUpdateAndCostsNoAccuracy) {
  ModelSettings settings = ModelSettings::from_preset("default", 1);
  for (const auto& [name, value] :
       std::initializer_list<std::pair<const char*, const char*>>{{"learner", "svr"},
                                                                  {"terms", "none"},
                                                                  {"fine", "0"},
                                                                  {"gamma", "1"},
                                                                  {"buffer", "500"},
                                                                  {"epsilon", "0.0001"},
                                                                  {"c", "1000"}}) {
    settings.assign(name, value);
  }
  DynamicsModel model({"a", "b", "c"}, {"y"}, settings);
  RandomStream random(3, "work limit");
  constexpr int kSamples = 1000;
  int most = 0;
  double late_error = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    std::array<double, 3> x{};
    std::ranges::generate(x, [&] { return random.uniform(-2.0, 2.0); });
    const double y =
        std::sin(2.0 * x[0]) * std::cos(x[1]) + 0.3 * x[2] * x[2] + 0.1 * random.normal();
    model.update(x, {&y, 1}, 0.1 * i);
    const Decision& decision = model.decisions()[0];
    most = std::max(most, decision.iterations);
    late_error += i < kSamples / 2 ? 0.0 : std::pow(decision.prediction.value - y, 2);
  }
  const Status status = model.axis(0).status();
  EXPECT_LE(most, 80);
  EXPECT_GT(status.tally.unfinished, 50);
  EXPECT_LE(status.tally.crowded_out, kSamples / 50);
  EXPECT_LT(status.kkt_gap, 1e-3);
  EXPECT_LT(std::sqrt(2.0 * late_error / kSamples), 0.20);  // 0.18 without a limit
}

}  // namespace
}  // namespace kelpie::work_limit_test
