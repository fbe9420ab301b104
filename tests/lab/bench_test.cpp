// SPDX-License-Identifier: Apache-2.0
#include "lab/bench.hpp"

#include <gtest/gtest.h>

#include "lab/soak.hpp"
#include "study/small_log.hpp"
#include "support.hpp"

namespace kelpie::bench_test {
namespace {

using testing::message_of;
using testing::small_log;

lab::BenchPlan small_plan() {
  lab::BenchPlan plan;
  plan.window = 40;
  plan.compared = 60;
  plan.block = 25;
  plan.whole = 100;
  plan.windows = {20, 40, 100'000};
  plan.repeats = {1, 4};
  plan.growth_updates = 10;
  plan.kernel_rounds = 3;
  plan.model_updates = 60;
  return plan;
}

TEST(Bench, MeasuresEverySolverOnEveryAxis) {
  const lab::BenchResult result =
      lab::run_bench({{small_log(300, 2), false}, {small_log(200), true}}, small_plan());
  ASSERT_EQ(result.axes.size(), 3U);
  EXPECT_FALSE(result.interrupted);
  EXPECT_FALSE(result.axes[0].simulated);
  EXPECT_TRUE(result.axes[2].simulated);
  EXPECT_EQ(result.axes[0].epsilon, 0.1);
  EXPECT_EQ(result.axes[1].epsilon, 0.001);
  for (const lab::BenchAxis& axis : result.axes) {
    ASSERT_EQ(axis.runs.size(), 3U);
    for (const lab::SolverRun& run : axis.runs) {
      EXPECT_EQ(run.update_us.size(), 60U);
      EXPECT_EQ(run.steps.size(), 60U);
      EXPECT_LE(run.gap, 1.001 * result.settings.tolerance);
    }
    EXPECT_EQ(axis.libsvm_us.size(), 3U);
    EXPECT_EQ(axis.whole.update_us.size(), 100U);
    EXPECT_LE(axis.whole.gap, 1e-5);  // in single precision
    EXPECT_EQ(axis.learner_update_us.size(), 100U);
    EXPECT_GT(axis.learner_buffer, 0);
  }
  ASSERT_EQ(result.over_window.size(), 2U);
  EXPECT_EQ(result.over_window[0].sizes, (std::vector<double>{20.0, 40.0}));  // as rows allow
  EXPECT_EQ(result.over_inputs[1].sizes, (std::vector<double>{2.0, 8.0}));
  EXPECT_EQ(result.kernel.samples, 40U);
  EXPECT_LT(result.memory.path_float, result.memory.path_double);
}

// The solvers' work doesn't depend on how long anything took.
TEST(Bench, MakesTheSameStepsAgain) {
  const lab::BenchResult a = lab::run_bench({{small_log(200), false}}, small_plan());
  const lab::BenchResult b = lab::run_bench({{small_log(200), false}}, small_plan());
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(a.axes[0].runs[i].steps, b.axes[0].runs[i].steps);
    EXPECT_EQ(a.axes[0].runs[i].gap, b.axes[0].runs[i].gap);
  }
}

TEST(Bench, StopsWhenAsked) {
  lab::BenchPlan plan = small_plan();
  int asked = 0;
  double share = 0.0;
  plan.keep_going = [&](double done) {
    EXPECT_GE(done, share);
    share = done;
    return ++asked < 100;
  };
  const lab::BenchResult result = lab::run_bench({{small_log(300, 2), false}}, plan);
  EXPECT_TRUE(result.interrupted);
  EXPECT_EQ(asked, 100);
}

TEST(Bench, CountsItsProgressToTheEnd) {
  lab::BenchPlan plan = small_plan();
  plan.windows = {20, 40};
  double share = 0.0;
  plan.keep_going = [&](double done) { return (share = done) <= 1.0; };
  lab::run_bench({{small_log(300, 2), false}, {small_log(200), true}}, plan);
  EXPECT_DOUBLE_EQ(share, 1.0);
}

TEST(Bench, RefusesAStreamTooShortForItsWindow) {
  const std::string message = message_of<InputError>([] {
    lab::run_bench({{small_log(80), false}}, small_plan());
  });
  EXPECT_EQ(message, "small.csv: has 80 rows; a window of 40 needs 90");
}

TEST(Soak, TheSolverKeepsItsPromisesOnAHardStream) {
  lab::SoakPlan plan;
  plan.updates = 4000;
  plan.window = 80;
  plan.check_every = 100;
  const std::vector<lab::SoakRun> runs = lab::run_soak(plan);
  ASSERT_EQ(runs.size(), 2U);
  for (const lab::SoakRun& run : runs) {
    EXPECT_EQ(run.updates, plan.updates);
    EXPECT_TRUE(run.good()) << run.gap << " " << run.fallbacks;
    EXPECT_GT(run.gap, 0.0);
  }
  const std::vector<lab::SoakRun> again = lab::run_soak(plan);
  EXPECT_EQ(runs[0].gap, again[0].gap);
  EXPECT_EQ(runs[1].gap, again[1].gap);
}

TEST(Soak, IsBadWithAGapOrFallbacksBeyondWhatIsAllowed) {
  lab::SoakRun run{.updates = 1'000'000, .fallbacks = 10, .gap = 1e-7, .gap_allowed = 1e-6};
  EXPECT_TRUE(run.good());
  run.fallbacks = 11;
  EXPECT_FALSE(run.good());
  run.fallbacks = 0;
  run.gap = 2e-6;
  EXPECT_FALSE(run.good());
}

}  // namespace
}  // namespace kelpie::bench_test
