// SPDX-License-Identifier: Apache-2.0
#include "report/html.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "chart/markup_check.hpp"
#include "chart/wording.hpp"
#include "report/synthetic.hpp"
#include "study/summary.hpp"

namespace kelpie::html_test {
namespace {

// What every page must be, whatever the result.
void expect_sound(const std::string& page, const std::string& what) {
  const Markup markup = take_apart(page);
  EXPECT_EQ(markup.fault, "") << what;
  EXPECT_GT(markup.elements.size(), 10U) << what;
  for (const std::string part : {"http://", "https://", "<script", "url(", "<link", "<img"}) {
    EXPECT_EQ(page.find(part), std::string::npos) << what << ": " << part;
  }
  for (const Element& element : markup.elements) {
    for (const std::string name : {"d", "x", "y", "transform", "viewBox"}) {
      EXPECT_EQ(element[name].find("nan"), std::string::npos) << what;
      EXPECT_EQ(element[name].find("inf"), std::string::npos) << what;
    }
  }
}

TEST(Html, IsSoundForOneThreeAndSevenAxes) {
  for (const std::size_t axes : {0U, 1U, 3U, 7U}) {
    const std::string page = report::report_html(synthetic::stream(axes));
    expect_sound(page, std::to_string(axes) + " axes");
    EXPECT_EQ(page.find("\uFFFD"), std::string::npos);  // what can't be shown becomes that
    // Validation and stretches are drawn twice (wide and narrow), the other five figures once.
    EXPECT_EQ(occurrences(page, "<svg"), 2 + axes * (2 + 5));
  }
}

TEST(Html, WithTermsItShowsWhatTheModelBelieves) {
  const std::string heading = "What the model believes about the vehicle";
  EXPECT_EQ(report::report_html(synthetic::stream(2)).find(heading), std::string::npos);
  study::StreamResult result = synthetic::stream_with_terms(2);
  result.axes[0].terms.clear();  // not every axis has to have them
  result.axes[1].terms[0].formula = "'<b>'*|u|";
  const std::string page = report::report_html(result);
  expect_sound(page, "terms");
  EXPECT_NE(page.find(heading), std::string::npos);
  EXPECT_EQ(occurrences(page, "<svg"), 2 + 2 * (2 + 5) + 2);
  EXPECT_NE(
      page.find("<td>0.001000</td><td>–</td><td>m rev^-2</td><td>0.002000</td><td>−50 %</td>"),
      std::string::npos);
}

TEST(Html, EveryTotalIsShown) {
  study::StreamResult result = synthetic::stream(1);
  // NOLINTNEXTLINE(misc-const-correctness): written to through pointers to members
  Tally& tally = result.axes.front().status.tally;
  std::int64_t number = 7'100;
  for (const TallyField& field : tally_fields()) {
    tally.*field.total = ++number;
  }
  const std::string page = report::report_html(result);
  const std::int64_t turned_away =
      tally.explained + tally.duplicate + tally.invalid + tally.implausible;
  for (const TallyField& field : tally_fields()) {
    const std::int64_t shown = study::turned_away(field) ? turned_away : tally.*field.total;
    EXPECT_NE(page.find("<td>" + chart::grouped(shown) + "</td>"), std::string::npos) << field.key;
  }
  EXPECT_NE(page.find(">crowded out</text>"), std::string::npos);  // in the shares' legend
}

TEST(Html, SaysTheResultInWords) {
  study::StreamResult result = synthetic::stream(3);
  result.axes[1].r2_final = -0.31;
  result.axes[2].r2_final = synthetic::kNan;
  const std::string page = report::report_html(result);
  EXPECT_NE(page.find("explains 95.1 % of the variance of axis0"), std::string::npos);
  EXPECT_NE(page.find("worse than the mean of the held-out rows would: axis1 (R² −0.310)"),
            std::string::npos);
  EXPECT_NE(page.find("No R² was measured for axis2"), std::string::npos);
}

TEST(Html, SaysWhereEverythingCameFrom) {
  const std::string page = report::report_html(synthetic::stream(1));
  for (const std::string fact :
       {"logs/dive_7.csv", "2,503 read, 3 skipped", "first 200 samples",
        "blocks of 400 rows, every 5th held out", "0.1,0.25,0.5", "4 Hz"}) {
    EXPECT_NE(page.find(fact), std::string::npos) << fact;
  }
  EXPECT_EQ(page.find("interrupted after"), std::string::npos);
}

TEST(Html, AnInterruptedRunSaysSoBeforeAnyResult) {
  const std::string page = report::report_html(synthetic::stopped_at_once());
  expect_sound(page, "stopped at once");
  const std::size_t notice = page.find("This run was interrupted after 20 of 2,000");
  ASSERT_NE(notice, std::string::npos);
  EXPECT_LT(notice, page.find("<table"));
  EXPECT_LT(notice, page.find("No R² was measured"));
  EXPECT_NE(page.find(">no data</text>"), std::string::npos);
}

TEST(Html, HostileTextFromTheLogIsShownNotRun) {
  const std::string evil = "<script>alert(1)</script>\"'&\x01\xff";
  study::StreamResult result = synthetic::stream(2);
  result.source = "logs/" + evil;
  result.split = result.scales = evil;
  result.input_names = {evil};
  result.settings = {{evil, evil}};
  result.axes[0].name = evil;
  expect_sound(report::report_html(result), "hostile text");
}

TEST(Html, EmptyConstantAndBrokenSeriesAreSound) {
  study::StreamResult result = synthetic::stream(5);
  result.axes[0].validation.resize(1);
  result.axes[1] = study::AxisResult{};
  result.axes[2].held_out_true.assign(result.axes[2].held_out_true.size(), 0.5);
  result.axes[2].held_out_predicted = result.axes[2].held_out_true;
  result.axes[2].update_us.assign(100, 0.0);
  for (double& value : result.axes[3].held_out_predicted) {
    value = std::numeric_limits<double>::infinity();
  }
  for (study::ValidationPoint& point : result.axes[4].validation) {
    point.r2 = synthetic::kNan;
  }
  result.rate_hz = synthetic::kNan;
  const std::string page = report::report_html(result);
  expect_sound(page, "odd series");
}

TEST(Html, ALongStreamStaysASmallFile) {
  study::StreamResult result = synthetic::stream(7, 30'000);
  for (study::AxisResult& axis : result.axes) {
    std::vector<study::ValidationPoint> every;
    for (std::size_t n = 1; n <= 30'000; ++n) {
      every.push_back({n, 0.25 * static_cast<double>(n), n % 2 == 0 ? 0.9 : 0.1, 1,
                       synthetic::status_after(n)});
    }
    axis.validation = every;
  }
  EXPECT_LT(report::report_html(result).size(), 1'500'000U);
}

TEST(Html, SameResultSameBytes) {
  EXPECT_EQ(report::report_html(synthetic::stream(2)), report::report_html(synthetic::stream(2)));
}

}  // namespace
}  // namespace kelpie::html_test
