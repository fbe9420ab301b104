// SPDX-License-Identifier: Apache-2.0
#include "report/recommendation.hpp"

#include <gtest/gtest.h>

#include <string>

#include "core/text.hpp"
#include "report/comparisons.hpp"

namespace kelpie::recommendation_test {
namespace {

using synthetic::comparison;
using synthetic::kNan;

std::string text(const study::Comparison& comparison) {
  return join_text(report::recommendation(comparison), "\n");
}

void expect_says(const study::Comparison& comparison, const std::string& words) {
  EXPECT_NE(text(comparison).find(words), std::string::npos) << words << "\n" << text(comparison);
}

void expect_silent(const study::Comparison& comparison, const std::string& words) {
  EXPECT_EQ(text(comparison).find(words), std::string::npos) << words << "\n" << text(comparison);
}

TEST(Recommendation, KelpieWhereNothingIsClearlyBetter) {
  const study::Comparison level = comparison({.kelpie = 0.93, .variant = 0.939, .fit = 0.935});
  expect_says(level, "axis0: kelpie is the best here, or within 0.01 of it (R² 0.930).");
  expect_says(level, "None of the settings tried (terms=none) is better");
}

TEST(Recommendation, WhereKelpieIsTheBestIsNoNews) {
  const auto is_news = [](double fit) {
    return report::all_advice(comparison({.kelpie = 0.93, .variant = 0.9, .fit = fit}))
        .front()
        .is_news;
  };
  EXPECT_FALSE(is_news(0.9));
  EXPECT_TRUE(is_news(0.99));
}

TEST(Recommendation, LeastSquaresWhereTheyAreClearlyBetter) {
  const study::Comparison fitted = comparison({.kelpie = 0.88, .variant = 0.80, .fit = 0.93});
  expect_says(fitted, "axis0: least squares on physics terms is better (R² 0.930 against 0.880)");
  expect_silent(fitted, "kelpie is the best");
}

TEST(Recommendation, TheMeanWhereNothingExplainsTheAxis) {
  const study::Comparison blind = comparison({.kelpie = -0.3, .variant = -0.1, .fit = 0.005});
  expect_says(blind, "axis0: nothing here predicts better than the mean (R² −0.300 against 0.000)");
  expect_says(blind, "nothing in the inputs explains it");
  expect_says(blind, "kelpie is worse: don't use what it says of this axis");
  expect_silent(comparison({.kelpie = 0.0, .variant = 0.0, .fit = 0.0}), "kelpie is worse");
}

TEST(Recommendation, NobodyIsOfUseBelowZeroHoweverTheMeanDoes) {
  study::Comparison blind = comparison({.kelpie = -0.025, .variant = -0.003, .fit = -0.039});
  for (study::Contest& contest : blind.contests) {
    if (contest.kind == study::ContenderKind::mean) {
      contest.stream.axes[0].r2_final = -0.024;  // of the rows so far, on others
    }
  }
  expect_says(blind, "nothing here predicts better than the mean (R² −0.025 against −0.024)");
  expect_says(blind, "None of the settings tried (terms=none) is better");
}

TEST(Recommendation, WhatIsNoBetterThanTheMeanIsSaidBesideWhatIs) {
  const study::Comparison fitted = comparison({.kelpie = -0.1, .variant = -0.2, .fit = 0.6});
  expect_says(fitted, "axis0: kelpie is no better than the mean (R² −0.100 against 0.000). least");
  expect_silent(fitted, "nothing in the inputs");
}

TEST(Recommendation, ASettingThatGainsOnInnerSplitsAndOnHeldOutRows) {
  study::Comparison varied = comparison({.kelpie = 0.88, .variant = 0.92, .fit = 0.5});
  expect_says(varied, "No gain: keep the defaults.");
  varied.contests[1].inner_gains = {0.03, 0.02};
  expect_says(varied,
              "Use --set terms=none: R² is higher by 0.030 and 0.020 on inner splits of the "
              "training rows, and by 0.040 on the held-out rows");
  varied.contests[1].inner_gains = {0.03, -0.01};
  expect_says(varied, "No gain: keep the defaults.");
}

TEST(Recommendation, ASettingThatHelpsOneAxisAndHarmsAnotherIsNotForAll) {
  study::Comparison mixed = comparison({.kelpie = 0.88, .variant = 0.92, .fit = 0.5}, 2);
  mixed.contests[1].stream.axes[1].r2_final = 0.5;
  mixed.contests[1].inner_gains = {0.03, 0.02};
  expect_says(mixed, "axis1: kelpie is the best");
  expect_says(mixed, "None of the settings tried (terms=none) is better");
}

TEST(Recommendation, RepeatingTheLastValueWhereItIsBetterOneStepAhead) {
  study::Comparison smooth = comparison({.kelpie = 0.9, .variant = 0.9, .fit = 0.9}, 2);
  smooth.contests[0].stream.axes[0].prequential_r2 = 0.98;
  smooth.contests[0].stream.axes[1].prequential_r2 = 0.995;
  for (study::AxisResult& axis : smooth.contests.back().stream.axes) {
    axis.prequential_r2 = 0.991;
  }
  expect_says(smooth,
              "One step ahead, repeating the last value is better on axis0 (R² 0.991 against "
              "0.980): use kelpie's predictions for what lies further ahead.");
}

TEST(Recommendation, NothingOfWhatWasNotMeasured) {
  study::Comparison bare = comparison({.kelpie = kNan, .variant = kNan, .fit = kNan});
  expect_says(bare, "axis0: kelpie has no R² here");
  expect_silent(bare, "better (R²");
  bare = comparison({.kelpie = 0.9, .variant = kNan, .fit = kNan});
  expect_says(bare, "axis0: kelpie is the best");
  bare.contests.resize(1);
  EXPECT_EQ(report::recommendation(bare).size(), 1U);
}

}  // namespace
}  // namespace kelpie::recommendation_test
