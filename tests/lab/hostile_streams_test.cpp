// SPDX-License-Identifier: Apache-2.0
#include "lab/hostile_streams.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <vector>

namespace kelpie::hostile_streams_test {
namespace {

using namespace lab;
using Eigen::Index;

HostileStream stream_of(const std::string& name) {
  const std::vector<HostileKind> kinds = hostile_kinds();
  const auto kind = std::ranges::find(kinds, name, &HostileKind::name);
  EXPECT_NE(kind, kinds.end()) << name;
  return kind->stream(1);
}

double deviation(const Eigen::ArrayXXd& values) {
  return std::sqrt((values - values.mean()).square().mean());
}

TEST(HostileStreams, AreWholeAndTheSameForASeed) {
  std::set<std::string> names;
  for (const HostileKind& kind : hostile_kinds()) {
    SCOPED_TRACE(kind.name);
    EXPECT_TRUE(names.insert(kind.name).second);
    EXPECT_FALSE(kind.meaning.empty());
    const HostileStream stream = kind.stream(1);
    ASSERT_EQ(stream.x.rows(), static_cast<Index>(stream.inputs.size()));
    ASSERT_EQ(stream.y.rows(), static_cast<Index>(stream.targets.size()));
    ASSERT_EQ(stream.truth.rows(), stream.y.rows());
    for (const Eigen::ArrayXXd* rows : {&stream.x, &stream.y, &stream.truth}) {
      ASSERT_EQ(rows->cols(), kHostileSamples);
      EXPECT_TRUE(rows->allFinite());
    }
    EXPECT_GT((stream.times_s.tail(kHostileSamples - 1) - stream.times_s.head(kHostileSamples - 1))
                  .minCoeff(),
              0.0);
    for (Index axis = 0; axis < stream.truth.rows(); ++axis) {
      EXPECT_GT(deviation(stream.truth.row(axis).tail(kHostileSamples / 4)), 0.0);
    }
    EXPECT_TRUE((kind.stream(1).y == stream.y).all());
    EXPECT_FALSE((kind.stream(2).y == stream.y).all());
  }
}

// Samples whose targets are more than ten deviations from the truth, and hidden samples.
struct Faults {
  explicit Faults(const HostileStream& stream) {
    const double size = deviation(stream.truth);
    for (Index i = 0; i < kHostileSamples; ++i) {
      if ((stream.y.col(i) - stream.truth.col(i)).abs().maxCoeff() > 10.0 * size) {
        far.insert(i);
      }
      if (stream.hidden[static_cast<std::size_t>(i)]) {
        hidden.insert(i);
      }
    }
  }

  std::set<Index> far;
  std::set<Index> hidden;
};

void expect_stretch(const std::set<Index>& samples, Index begin, Index count) {
  ASSERT_FALSE(samples.empty());
  EXPECT_EQ(*samples.begin(), begin);
  EXPECT_EQ(*samples.rbegin(), begin + count - 1);
  EXPECT_EQ(samples.size(), static_cast<std::size_t>(count));
}

TEST(HostileStreams, FaultsAreWhereTheirNamesSay) {
  EXPECT_TRUE(Faults(stream_of("clean")).far.empty());
  const Faults burst(stream_of("one_burst"));
  expect_stretch(burst.far, 1500, 40);
  EXPECT_TRUE(burst.hidden.empty());
  const Faults midway(stream_of("garbage_midway"));
  expect_stretch(midway.far, 2000, 150);
  expect_stretch(midway.hidden, 2000, 150);
  const Faults first(stream_of("garbage_first_30s"));
  expect_stretch(first.far, 0, 150);
  expect_stretch(first.hidden, 0, 150);
  const Faults five(stream_of("bursts_of_five"));
  EXPECT_EQ(five.far.size(), 37U * 5U);
  EXPECT_TRUE(std::ranges::all_of(five.far, [](Index i) { return i >= 300 && i % 100 < 5; }));
  EXPECT_GT(Faults(stream_of("half_outliers")).far.size(), 500U);
  expect_stretch(Faults(stream_of("sign_flip_minute")).hidden, 2000, 300);
}

TEST(HostileStreams, DrivesAndSensorsAreWhatTheirNamesSay) {
  const HostileStream held = stream_of("held_20_rows");
  EXPECT_TRUE((held.x.col(40) == held.x.col(59)).all());
  EXPECT_FALSE((held.x.col(59) == held.x.col(60)).all());
  const HostileStream collinear = stream_of("collinear");
  EXPECT_LT((collinear.x.row(3) - collinear.x.row(4)).abs().maxCoeff(), 1e-6);
  EXPECT_GT(deviation(collinear.x.row(3)), 0.1);
  const HostileStream rest = stream_of("rest_first");
  EXPECT_LT(rest.x.leftCols(kHostileSamples / 2).abs().maxCoeff(), 0.05);
  EXPECT_GT(deviation(rest.x.rightCols(kHostileSamples / 2)), 0.1);
  const HostileStream equal = stream_of("equal_inputs");
  EXPECT_TRUE((equal.x.row(63) == equal.x.row(0)).all());
  const HostileStream degrees = stream_of("rad_to_deg");
  EXPECT_NEAR(
      deviation(degrees.truth.row(2).tail(2000)) / deviation(degrees.truth.row(2).head(2000)),
      180.0 / std::numbers::pi, 10.0);
  const HostileStream gaps = stream_of("gaps_of_a_day");
  EXPECT_NEAR(gaps.times_s[500] - gaps.times_s[499], 86400.2, 1e-6);
  EXPECT_NEAR(gaps.times_s[499] - gaps.times_s[498], 0.2, 1e-9);
}

}  // namespace
}  // namespace kelpie::hostile_streams_test
