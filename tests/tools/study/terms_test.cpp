// SPDX-License-Identifier: Apache-2.0
#include "study/terms.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "report/synthetic.hpp"

namespace kelpie::terms_test {
namespace {

TEST(TermViews, CompareTheEndWithTheLastLookOfTheFirstHalf) {
  const std::vector<study::TermView> views =
      study::term_views(synthetic::stream_with_terms(1, 2000).axes.front());
  ASSERT_EQ(views.size(), 2U);
  EXPECT_EQ(views[1].at_half, 0.002);
  EXPECT_EQ(views[1].value, 0.001);
  EXPECT_EQ(views[1].effect, 0.001 * 40.0);
  EXPECT_EQ(views[0].effect, -0.8 * 0.25);
  ASSERT_EQ(views[1].values.size(), 40U);
  EXPECT_TRUE(std::isnan(views[1].values[1]));  // no model in service yet
  EXPECT_TRUE(std::isnan(views[1].errors[1]));
  EXPECT_EQ(views[1].values[2], 0.002);
  EXPECT_EQ(views[1].errors[2], 1e-4);
}

TEST(TermViews, WithoutALookInTheFirstHalfNothingIsSaidOfIt) {
  study::AxisResult axis = synthetic::stream_with_terms(1, 2000).axes.front();
  axis.validation.erase(axis.validation.begin(), axis.validation.end() - 3);
  EXPECT_TRUE(std::isnan(study::term_views(axis)[0].at_half));
  EXPECT_EQ(study::term_views(axis)[0].value, -0.8);
  axis.validation.clear();
  EXPECT_TRUE(std::isnan(study::term_views(axis)[0].value));
}

TEST(TermViews, TheMostEffectiveKeepTheirOrderAndTiesTheirNumber) {
  std::vector<study::TermView> views(4);
  const std::array<double, 4> effects{1.0, -3.0, 0.0, 2.0};
  for (std::size_t k = 0; k < 4; ++k) {
    views[k].term.formula = std::to_string(k);
    views[k].term.rms = 0.5;
    views[k].values = {synthetic::kNan, 2.0 * effects[k]};
  }
  const std::vector<study::TermView> two = study::most_effective(views, 2);
  ASSERT_EQ(two.size(), 2U);
  EXPECT_EQ(two[0].term.formula, "1");
  EXPECT_EQ(two[1].term.formula, "3");
  EXPECT_EQ(study::most_effective(views, 9).size(), 4U);
  for (study::TermView& view : views) {
    view.values.clear();
  }
  EXPECT_EQ(study::most_effective(views, 3).size(), 3U);
}

}  // namespace
}  // namespace kelpie::terms_test
