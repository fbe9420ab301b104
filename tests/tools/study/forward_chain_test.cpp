// SPDX-License-Identifier: Apache-2.0
#include "study/forward_chain.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "kelpie/core/error.hpp"
#include "study/small_log.hpp"
#include "study/split.hpp"
#include "support.hpp"

namespace kelpie::forward_chain_test {
namespace {

using testing::all_rows;
using testing::message_of;
using testing::row_of;
using testing::small_log;

constexpr std::size_t kWarmup = 20;

// What all learners of one scoring were shown.
struct Notes {
  std::set<std::size_t> learned;
  std::map<std::size_t, std::size_t> judged;  // row → how often
  bool saw_future = false;
  std::size_t judged_early = 0;  // judgements before kWarmup rows were learned
};

// Predicts a constant, and notes which rows it is shown.
class Spy final : public OnlineRegressor {
 public:
  Spy(Notes& notes, double constant, int iterations)
      : notes_(notes), constant_(constant), iterations_(iterations) {}

  Decision update(std::span<const double> x, double /*y*/, double /*t*/) override {
    own_.insert(row_of(x[1]));
    notes_.learned.insert(row_of(x[1]));
    return {.iterations = iterations_};
  }
  double predict(std::span<const double> x) const override {
    const std::size_t row = row_of(x[1]);
    ++notes_.judged[row];
    notes_.saw_future = notes_.saw_future || own_.empty() || *own_.rbegin() >= row;
    notes_.judged_early += own_.size() < kWarmup ? 1 : 0;
    return constant_;
  }
  Status status() const override { return {}; }

 private:
  Notes& notes_;
  double constant_;
  int iterations_;
  std::set<std::size_t> own_;
};

study::ChainScore score(const study::ForwardChain& chain, std::size_t rung, Notes& notes,
                        double constant = 0.0, int iterations = 0) {
  return chain.score(
      rung, 0, [&] { return std::make_unique<Spy>(notes, constant, iterations); }, 10.0,
      [](std::size_t) { return true; });
}

TEST(ForwardChain, NobodyIsJudgedOnWhatItLearnedOrLearnsTheFutureBefore) {
  const log::Dataset data = small_log(2400);
  for (const study::SplitKind kind :
       {study::SplitKind::blocks, study::SplitKind::random, study::SplitKind::tail}) {
    const study::Split split = study::make_split(data, {.kind = kind});
    const std::set<std::size_t> held_out(split.held_out.begin(), split.held_out.end());
    const study::ForwardChain chain(data, split.training, kWarmup);
    ASSERT_EQ(chain.rungs().size(), 3U);
    for (std::size_t rung = 0; rung < 3; ++rung) {
      Notes notes;
      score(chain, rung, notes);
      EXPECT_FALSE(notes.saw_future);
      EXPECT_EQ(notes.judged_early, 0U);
      EXPECT_FALSE(notes.learned.empty());
      EXPECT_FALSE(notes.judged.empty());
      for (const std::size_t row : notes.learned) {
        EXPECT_FALSE(held_out.contains(row)) << "a held-out row was learned";
      }
      for (const auto& [row, times] : notes.judged) {
        EXPECT_FALSE(held_out.contains(row)) << "a held-out row was judged";
        EXPECT_EQ(times, 1U);
      }
    }
  }
}

TEST(ForwardChain, TheLastRungJudgesAllRowsAfterTheStartAndCheapOnesAreSpread) {
  const log::Dataset data = small_log(2400);
  const study::ForwardChain chain(data, all_rows(2400), kWarmup);
  Notes notes;
  score(chain, 2, notes);
  EXPECT_EQ(notes.judged.size(), 2000U);  // all but the first sixth
  EXPECT_EQ(notes.judged.rbegin()->first, 2399U);
  const study::Rung& first = chain.rungs().front();
  ASSERT_EQ(first.windows.size(), 3U);
  EXPECT_EQ(first.windows.front().begin, 0U);
  EXPECT_EQ(first.windows.back().end, 2400U);
  EXPECT_LT(first.rows, chain.rungs()[1].rows);
  EXPECT_LT(chain.rungs()[1].rows, 2400U);
}

TEST(ForwardChain, ScoreIsMeanSquaredErrorOverTheVarianceOfAllRows) {
  log::Dataset data = small_log(600);
  for (double& y : data.targets) {
    y += 5.0;
  }
  const study::ForwardChain chain(data, all_rows(600), kWarmup);
  const std::size_t last = chain.rungs().size() - 1;
  Notes notes;
  double variance = 0.0;
  for (const double y : data.targets) {
    variance += (y - 5.0) * (y - 5.0) / 599.0;
  }
  const study::ChainScore mean = score(chain, last, notes, 5.0);
  EXPECT_NEAR(mean.score, 0.0, 0.02);
  ASSERT_EQ(mean.stretches.size(), 5U);
  // A constant bias costs its square over the one common variance, in every stretch alike.
  const study::ChainScore biased = score(chain, last, notes, 6.0);
  EXPECT_NEAR(mean.score - biased.score, 1.0 / variance, 0.05);
}

TEST(ForwardChain, AQuietStretchCountsNoMoreThanALivelyOne) {
  log::Dataset data = small_log(600);
  for (std::size_t i = 400; i < 600; ++i) {
    data.targets[i] *= 1e-3;  // the vehicle drifts
  }
  const study::ForwardChain chain(data, all_rows(600), kWarmup);
  Notes notes;
  const study::ChainScore result = score(chain, chain.rungs().size() - 1, notes, 0.01);
  EXPECT_GT(result.stretches.back(), 0.99) << "an error of 0.01 is small wherever it is made";
}

TEST(ForwardChain, GivesUpOnASolverThatNeedsTooLong) {
  const log::Dataset data = small_log(600);
  const study::ForwardChain chain(data, all_rows(600), kWarmup);
  Notes notes;
  EXPECT_FALSE(score(chain, 0, notes, 0.0, 10).given_up);
  const study::ChainScore result = score(chain, 0, notes, 0.0, 1000);
  EXPECT_TRUE(result.given_up);
  EXPECT_TRUE(std::isnan(result.score));
}

TEST(ForwardChain, TooFewRowsAreRefusedWithTheNumberNeeded) {
  const log::Dataset data = small_log(49);
  EXPECT_NE(message_of<InputError>([&] {
              study::ForwardChain(data, all_rows(49), kWarmup);
            }).find("need 50 or more training rows"),
            std::string::npos);
  const log::Dataset enough = small_log(50);
  EXPECT_EQ(study::ForwardChain(enough, all_rows(50), kWarmup).rungs().size(), 1U);
}

}  // namespace
}  // namespace kelpie::forward_chain_test
