// SPDX-License-Identifier: Apache-2.0
#include "study/comparison.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "kelpie/core/error.hpp"
#include "model/axis_list.hpp"
#include "study/baselines.hpp"
#include "study/small_log.hpp"
#include "study/stream.hpp"
#include "support.hpp"

namespace kelpie::comparison_test {
namespace {

using study::ContenderKind;

// Says one value after so many samples, and has no model before.
class Late final : public OnlineRegressor {
 public:
  Late(std::size_t silent, double value) : silent_(silent), value_(value) {}

  Decision update(std::span<const double> /*x*/, double /*y*/, double /*t*/) override {
    return {.prediction = {.value = value_}, .had_model = shown_++ >= silent_};
  }
  double predict(std::span<const double> /*x*/) const override { return value_; }
  Status status() const override { return {.ready = shown_ > silent_}; }

 private:
  std::size_t silent_;
  double value_;
  std::size_t shown_ = 0;
};

study::Contender late(std::size_t silent, double value) {
  return {ContenderKind::variant, "late",
          [=] { return std::make_unique<AxisList>(std::make_unique<Late>(silent, value)); }};
}

class Comparison : public ::testing::Test {
 protected:
  std::vector<study::Contender> all(std::size_t targets = 1) const {
    ModelSettings settings = ModelSettings::from_preset("default", targets);
    settings.assign("warmup", "30");
    settings.assign("buffer", "60");
    std::vector<study::Contender> list{
        study::make_contender(ContenderKind::kelpie, "kelpie", data_, split_, settings)};
    settings.assign("terms", "none");
    list.push_back(
        study::make_contender(ContenderKind::variant, "terms=none", data_, split_, settings));
    for (study::Contender& baseline : study::baseline_contenders(data_)) {
      list.push_back(std::move(baseline));
    }
    return list;
  }

  log::Dataset data_ = testing::small_log(400, 2);
  study::Split split_ = study::make_split(data_, {.kind = study::SplitKind::pieces});
};

std::vector<double> figures_of(const study::Comparison& comparison) {
  std::vector<double> figures;
  for (const study::Contest& contest : comparison.contests) {
    for (const study::AxisResult& axis : contest.stream.axes) {
      for (const double value : {axis.r2_final, axis.r2_mean, axis.prequential_r2}) {
        figures.push_back(std::isnan(value) ? -999.0 : value);
      }
    }
  }
  return figures;
}

TEST_F(Comparison, ThreadsDoNotChangeTheResult) {
  const std::vector<double> one = figures_of(study::compare(data_, split_, all(2), {.threads = 1}));
  EXPECT_EQ(one.size(), 5U * 2U * 3U);
  EXPECT_EQ(figures_of(study::compare(data_, split_, all(2), {.threads = 3})), one);
}

TEST_F(Comparison, ContendersHaveWhatTheyHaveAlone) {
  const std::vector<study::Contender> contenders = all(2);
  const study::Comparison comparison = study::compare(data_, split_, contenders, {});
  study::StreamResult alone = study::run_stream(data_, split_, *contenders.front().make(), {});
  study::add_baselines(data_, split_, {}, alone);
  for (std::size_t i = 0; i < alone.axes.size(); ++i) {
    const auto of = [&](std::size_t contest) -> const study::AxisResult& {
      return comparison.contests[contest].stream.axes[i];
    };
    const study::AxisResult& axis = alone.axes[i];
    EXPECT_EQ(of(0).r2_final, axis.r2_final);
    EXPECT_EQ(of(0).r2_mean, axis.r2_mean);
    EXPECT_EQ(of(0).prequential_r2, axis.prequential_r2);
    EXPECT_EQ(comparison.one_step_samples[i], axis.one_step.samples.size());
    EXPECT_EQ(of(2).r2_final, axis.baselines.least_squares.r2_final);
    EXPECT_EQ(of(3).prequential_r2, axis.baselines.mean.prequential_r2);
    EXPECT_EQ(of(4).prequential_r2, axis.baselines.last_value.prequential_r2);
    EXPECT_TRUE(std::isnan(of(4).r2_final)) << "it tells nothing of held-out rows";
  }
}

TEST_F(Comparison, InnerSplitsAreOfTheTrainingRowsAlone) {
  const std::vector<study::Split> inner = study::inner_splits(split_);
  ASSERT_EQ(inner.size(), 2U);
  for (const study::Split& one : inner) {
    std::vector<std::size_t> rows = one.training;
    rows.insert(rows.end(), one.held_out.begin(), one.held_out.end());
    std::ranges::sort(rows);
    EXPECT_EQ(rows, split_.training) << one.label;
    EXPECT_NEAR(static_cast<double>(one.held_out.size()), 0.2 * static_cast<double>(rows.size()),
                5.0);  // pieces are whole
  }
  EXPECT_GT(inner[1].held_out.front(), inner[1].training.back());
  EXPECT_TRUE(study::inner_splits({.label = "", .training = {0, 1, 2}, .held_out = {}}).empty());
}

TEST_F(Comparison, AVariantIsBetterWhereItGainsOnEverySplit) {
  const auto contender = [&](ContenderKind kind, auto make) {
    return study::Contender{kind, "contender", [this, make] { return make(data_); }};
  };
  const auto compared = [&](auto kelpie, auto variant) {
    return study::compare(
        data_, split_,
        {contender(ContenderKind::kelpie, kelpie), contender(ContenderKind::variant, variant)}, {});
  };
  const study::Comparison gains = compared(study::make_mean, study::make_least_squares);
  EXPECT_EQ(gains.contests[1].inner_gains.size(), 2U);
  EXPECT_EQ(gains.better_variant(), &gains.contests[1]);
  const study::Comparison loses = compared(study::make_least_squares, study::make_mean);
  EXPECT_TRUE(loses.contests[1].inner_gains.empty()) << "nothing is learned for it";
  EXPECT_EQ(loses.better_variant(), nullptr);
}

TEST_F(Comparison, OneStepAheadIsJudgedOnTheSamplesThatAllPredicted) {
  data_ = testing::small_log(400);
  const std::size_t training = split_.training.size();
  const study::Comparison comparison = study::compare(
      data_, split_, {late(3, 0.5), late(training - 2, 0.5), late(training, 0.5)}, {});
  EXPECT_EQ(comparison.one_step_samples.front(), 2U);
  const auto r2 = [&](std::size_t contest) {
    return comparison.contests[contest].stream.axes.front().prequential_r2;
  };
  EXPECT_EQ(r2(0), r2(1));
  EXPECT_TRUE(std::isfinite(r2(0)));
  EXPECT_TRUE(std::isnan(r2(2))) << "it never predicted, and takes nothing from the others";
}

TEST_F(Comparison, WithoutASampleInCommonThereIsNoOneStepAhead) {
  data_ = testing::small_log(400);
  std::vector<study::Contender> contenders{late(0, 0.5), late(0, 0.5)};
  // The first speaks only on the first half, the second only on the second.
  class Half final : public OnlineRegressor {
   public:
    explicit Half(bool first) : first_(first) {}
    Decision update(std::span<const double> /*x*/, double /*y*/, double t) override {
      return {.had_model = (t < 40.0) == first_};
    }
    double predict(std::span<const double> /*x*/) const override { return 0.0; }
    Status status() const override { return {}; }

   private:
    bool first_;
  };
  for (const bool first : {true, false}) {
    contenders[first ? 0 : 1].make = [=] {
      return std::make_unique<AxisList>(std::make_unique<Half>(first));
    };
  }
  const study::Comparison comparison = study::compare(data_, split_, contenders, {});
  EXPECT_EQ(comparison.one_step_samples.front(), 0U);
  EXPECT_TRUE(std::isnan(comparison.contests.back().stream.axes.front().prequential_r2));
}

TEST_F(Comparison, StopsWhereItIsToldTo) {
  std::size_t calls = 0;
  study::compare(data_, split_, all(2), {.threads = 2, .keep_going = [&](double share) {
                                           EXPECT_LE(share, 1.0);
                                           return ++calls < 20;
                                         }});
  EXPECT_EQ(calls, 20U);
}

TEST_F(Comparison, WhatAContenderThrowsComesOut) {
  std::vector<study::Contender> contenders = all(2);
  contenders[1].make = []() -> std::unique_ptr<OnlineModel> { throw Failure("no memory"); };
  EXPECT_EQ(testing::message_of<Failure>(
                [&] { study::compare(data_, split_, contenders, {.threads = 2}); }),
            "no memory");
}

TEST_F(Comparison, AContenderThatCouldNeverFindItsScaleIsRefused) {
  ModelSettings settings = ModelSettings::from_preset("paper", 2);
  for (std::size_t row = 0; row < data_.rows(); ++row) {
    data_.inputs[2 * row + 1] = 3.0 * data_.inputs[2 * row];
  }
  EXPECT_NE(testing::message_of<InputError>([&] {
              study::make_contender(ContenderKind::variant, "paper", data_, split_, settings);
            }).find("singular"),
            std::string::npos);
}

}  // namespace
}  // namespace kelpie::comparison_test
