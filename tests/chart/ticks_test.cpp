// SPDX-License-Identifier: Apache-2.0
#include "chart/ticks.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <set>

namespace kelpie::ticks_test {
namespace {

std::vector<std::string> labels(const std::vector<chart::Tick>& ticks) {
  std::vector<std::string> texts;
  texts.reserve(ticks.size());
  for (const chart::Tick& tick : ticks) {
    texts.push_back(tick.label);
  }
  return texts;
}

using Labels = std::vector<std::string>;

TEST(Ticks, ReadAsAPersonWouldWriteThem) {
  EXPECT_EQ(labels(chart::linear_ticks({0.0, 1.0}, 6)),
            (Labels{"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
  EXPECT_EQ(labels(chart::linear_ticks({-0.2, 0.21}, 6)),
            (Labels{"−0.2", "−0.1", "0.0", "0.1", "0.2"}));
  EXPECT_EQ(labels(chart::linear_ticks({0.0, 9253.0}, 6)),
            (Labels{"0", "2,000", "4,000", "6,000", "8,000"}));
  EXPECT_EQ(labels(chart::linear_ticks({0.0, 4e9}, 6)),
            (Labels{"0", "1e+09", "2e+09", "3e+09", "4e+09"}));
}

TEST(Ticks, LogarithmicOnesThinOutToPowersOfTen) {
  EXPECT_EQ(labels(chart::logarithmic_ticks({0.1, 1.0}, 9)), (Labels{"0.1", "0.2", "0.5", "1"}));
  EXPECT_EQ(labels(chart::logarithmic_ticks({10.0, 1e5}, 6)),
            (Labels{"10", "100", "1,000", "10,000", "100,000"}));
  EXPECT_LE(chart::logarithmic_ticks({1e-12, 1e12}, 6).size(), 6U);
}

RC_GTEST_PROP(Ticks, LieInTheRangeEvenlyAtRoundStepsWithDifferentLabels, ()) {
  const double low = static_cast<double>(*rc::gen::inRange(-1'000'000, 1'000'000)) / 64.0;
  const double exponent = static_cast<double>(*rc::gen::inRange(-40, 60)) / 10.0;
  const int most = *rc::gen::inRange(2, 12);
  const chart::Extent range = chart::widened({low, low + std::pow(10.0, exponent)}, 0.0);
  const std::vector<chart::Tick> ticks = chart::linear_ticks(range, most);
  RC_ASSERT(!ticks.empty());
  RC_ASSERT(ticks.size() <= static_cast<std::size_t>(most));
  std::set<std::string> different;
  const double slack = 1e-6 * (range.high - range.low);
  for (const chart::Tick& tick : ticks) {
    RC_ASSERT(tick.value >= range.low - slack && tick.value <= range.high + slack);
    different.insert(tick.label);
  }
  RC_ASSERT(different.size() == ticks.size());
  if (ticks.size() > 1) {
    const double step = ticks[1].value - ticks[0].value;
    const double digit = step / std::pow(10.0, std::floor(std::log10(step) + 1e-6));
    RC_ASSERT(std::min({std::abs(digit - 1), std::abs(digit - 2), std::abs(digit - 5)}) < 1e-3);
  }
}

TEST(Ticks, AnyRangeBecomesOneThatCanBeDrawn) {
  const double huge = std::numeric_limits<double>::max();
  for (const chart::Extent range :
       {chart::Extent{0, 0}, chart::Extent{5, 5}, chart::Extent{-1e-320, 1e-320},
        chart::Extent{1.7e9, 1.7e9}, chart::Extent{-huge, huge}}) {
    const chart::Extent wide = chart::widened(range, 0.04);
    EXPECT_LT(wide.low, wide.high);
    EXPECT_TRUE(std::isfinite(wide.high - wide.low));
    EXPECT_FALSE(chart::linear_ticks(wide, 5).empty()) << range.low << " to " << range.high;
  }
}

TEST(Ticks, RangeLooksAtFiniteValuesOnly) {
  const double inf = std::numeric_limits<double>::infinity();
  const std::vector<double> values = {NAN, 3.0, -inf, -1.0, inf};
  EXPECT_EQ(chart::range_of(values).low, -1.0);
  EXPECT_EQ(chart::range_of(values).high, 3.0);
  EXPECT_LT(chart::range_of({}).low, chart::range_of({}).high);
}

TEST(Scale, MapsLinearlyOrByTheLogarithmAndStopsAtTheEdges) {
  const chart::Scale linear({0.0, 10.0}, {200.0, 0.0});
  EXPECT_DOUBLE_EQ(linear(2.5), 150.0);
  EXPECT_DOUBLE_EQ(linear(-4.0), 200.0);
  EXPECT_DOUBLE_EQ(linear(1e300), 0.0);
  const chart::Scale logarithmic({1.0, 1e4}, {0.0, 100.0}, chart::ScaleKind::logarithmic);
  EXPECT_DOUBLE_EQ(logarithmic(100.0), 50.0);
  EXPECT_DOUBLE_EQ(logarithmic(0.0), 0.0);
}

}  // namespace
}  // namespace kelpie::ticks_test
