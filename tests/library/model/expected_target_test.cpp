// SPDX-License-Identifier: Apache-2.0
// A calm vehicle with rare manoeuvres far beyond its usual targets, and sensors out of order.
#include "model/expected_target.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "kelpie/core/random.hpp"

namespace kelpie::expected_target_test {
namespace {

constexpr double kMean = 0.0;
constexpr double kNoise = 0.01;

struct Sample {
  std::array<double, 2> x{};
  double y = 0.0;
};

double acceleration(double speed, double thrust) {
  return thrust - 0.5 * speed - 0.8 * speed * std::abs(speed);
}

// Near rest, with little thrust; every 50th sample full thrust.
Sample sample(RandomStream& random, std::size_t i) {
  const bool manoeuvre = i % 50 == 49;
  const double speed = 0.05 * random.normal();
  const double thrust = manoeuvre ? (i % 100 == 49 ? 2.0 : -2.0) : 0.05 * random.normal();
  return {{speed, thrust}, acceleration(speed, thrust) + kNoise * random.normal()};
}

ExpectedTarget expected_target() {
  const std::vector<std::string> inputs{"speed", "thrust"};
  return ExpectedTarget(TermSet::from("quadratic", inputs, 1));
}

ExpectedTarget after_manoeuvres(std::size_t samples) {
  RandomStream random(5, "manoeuvres");
  ExpectedTarget expected = expected_target();
  for (std::size_t i = 0; i < samples; ++i) {
    const Sample one = sample(random, i);
    expected.learn(one.x, one.y, i % 50 == 49);
  }
  return expected;
}

TEST(ExpectedTarget, ManoeuvresLikeThoseBeforeAreExpected) {
  const ExpectedTarget expected = after_manoeuvres(500);
  for (const double thrust : {-2.0, -1.2, 1.2, 2.0}) {
    const std::array x{0.1, thrust};
    EXPECT_TRUE(expected.expects(x, acceleration(0.1, thrust), kMean)) << thrust;
  }
}

TEST(ExpectedTarget, GarbageIsNotExpected) {
  const ExpectedTarget expected = after_manoeuvres(500);
  const std::array calm{0.02, 0.03};
  const std::array ahead{0.1, 2.0};
  for (const double garbage : {-1e6, -2.0, 2.0, 1e6}) {
    EXPECT_FALSE(expected.expects(calm, garbage, kMean)) << garbage;
  }
  EXPECT_FALSE(expected.expects(ahead, -2.0, kMean));
  EXPECT_FALSE(expected.expects(ahead, 40.0, kMean));
}

// A sensor stuck for half of the time of the drive before, and stuck again at the same value.
TEST(ExpectedTarget, ASensorThatIsStuckDoesNotExplainItsNextStretch) {
  RandomStream random(6, "stuck");
  ExpectedTarget expected = after_manoeuvres(500);
  const double stuck = 0.9;
  const Sample first = sample(random, 0);
  for (std::size_t i = 0; i < 250; ++i) {
    const Sample one = sample(random, i % 40);
    expected.learn(one.x, stuck, true);
    EXPECT_FALSE(expected.expects(first.x, stuck, kMean)) << i;
  }
  for (std::size_t i = 0; i < 20; ++i) {
    const Sample one = sample(random, i);
    expected.learn(one.x, one.y, false);
  }
  EXPECT_FALSE(expected.expects(first.x, stuck, kMean));
}

TEST(ExpectedTarget, NothingIsExpectedBeforeTheFirstSample) {
  ExpectedTarget expected = after_manoeuvres(500);
  const std::array ahead{0.1, 2.0};
  ASSERT_TRUE(expected.expects(ahead, 2.0, kMean));
  expected.clear();
  EXPECT_FALSE(expected.expects(ahead, 2.0, kMean));
}

}  // namespace
}  // namespace kelpie::expected_target_test
