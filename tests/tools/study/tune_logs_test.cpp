// SPDX-License-Identifier: Apache-2.0
// One search over several logs.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <set>
#include <thread>

#include "kelpie/core/error.hpp"
#include "study/constant_error.hpp"
#include "study/small_log.hpp"
#include "study/tune.hpp"
#include "support.hpp"

namespace kelpie::tune_logs_test {
namespace {

using testing::all_rows;
using testing::message_of;
using testing::small_log;
using testing::TemporaryFolder;

// The error of a toy learner: grows with γ's distance from the best one, which is another on each
// log.
double error_of(const log::Dataset& data, double gamma) {
  return 0.1 * std::abs(std::log(gamma / (data.source == "first.csv" ? 0.1 : 0.9)));
}

study::TuneLog log_of(const std::string& source, std::size_t rows) {
  log::Dataset data = small_log(rows);
  data.source = source;
  return {std::move(data), all_rows(rows), "all rows"};
}

class TuneLogs : public ::testing::Test {
 protected:
  TuneLogs() {
    problem_.logs = {log_of("first.csv", 1200), log_of("second.csv", 120)};
    problem_.base = ModelSettings::from_preset("default", 1);
    problem_.base.assign("warmup", "20");
    problem_.base.assign("gamma", "0.1");
    problem_.space.search("gamma=0.05:1.5:log");
    options_.candidates = 30;
    options_.make_learner = [](const log::Dataset& data, const ModelSettings& settings) {
      return std::make_unique<testing::ConstantError>(error_of(data, settings.axes.front().gamma));
    };
  }

  study::TuneResult run(const std::string& journal, jobs::Executor& executor) const {
    study::TuneJournal file(folder_ / journal, study::journal_header(problem_, options_));
    return study::tune(problem_, options_, file, executor);
  }

  study::TuneResult run() const { return run("journal", *jobs::make_thread_executor(2)); }

  std::string complaint() const {
    return message_of<InputError>([&] { problem_.validate(); });
  }

  study::TuneProblem problem_;
  study::TuneOptions options_;
  TemporaryFolder folder_;
};

TEST_F(TuneLogs, EachCountsAlikeHoweverLongItIs) {
  const study::TuneResult result = run();
  const study::TunedAxis& axis = result.axes.front();
  const double ratio = std::log(0.9 / 0.1);
  EXPECT_NEAR(std::log(result.tuned.axes.front().gamma / 0.1), ratio / 2.0, 0.35)
      << "as far from the one as from the other, since errors are squared";
  ASSERT_EQ(axis.logs.size(), 2U);
  EXPECT_NEAR(axis.score, (axis.logs[0].tuned + axis.logs[1].tuned) / 2.0, 1e-12);
  EXPECT_NEAR(axis.all.tuned, axis.score, 1e-12);
  EXPECT_EQ(result.logs[1].name, "second.csv");
  EXPECT_EQ(result.logs[1].rows, 120U);
}

TEST_F(TuneLogs, TheScoresTellWhichLogIsWorseOff) {
  const study::TunedAxis axis = run().axes.front();
  EXPECT_LT(axis.logs[0].tuned, axis.logs[0].base);
  EXPECT_GT(axis.logs[1].tuned, axis.logs[1].base);
  EXPECT_GT(axis.all.tuned, axis.all.base);
  EXPECT_GT(axis.logs[0].least_squares, axis.logs[0].mean);
  EXPECT_EQ(axis.logs[0].references.size(), problem_.references.size());
}

TEST_F(TuneLogs, AShortOneIsEvaluatedOnceOnEachOfItsRungs) {
  const study::TuneResult result = run();
  ASSERT_EQ(result.logs[0].rungs.size(), 3U);
  ASSERT_LT(result.logs[1].rungs.size(), 3U);
  std::set<study::EvaluationKey> keys;
  for (const study::Evaluation& one : result.evaluations) {
    EXPECT_TRUE(keys.insert(one.key).second) << one.key.text();
  }
  EXPECT_EQ(std::ranges::count(result.trials, std::size_t{0}, &study::TrialResult::rung), 30);
}

TEST_F(TuneLogs, WhoIsGivenUpOnOneComesLast) {
  problem_.base.assign("gamma", "0.5");
  problem_.space = {};
  problem_.space.search("gamma=0.3,0.5");
  const auto toy = options_.make_learner;
  options_.make_learner = [&](const log::Dataset& data, const ModelSettings& settings) {
    const bool astray = settings.axes.front().gamma < 0.4 && data.source == "second.csv";
    return astray ? std::make_unique<testing::ConstantError>(NAN) : toy(data, settings);
  };
  EXPECT_EQ(run().tuned.axes.front().gamma, 0.5) << "0.3 is the better one on both together";
}

TEST_F(TuneLogs, TargetsHaveToAgree) {
  problem_.logs[1].data.target_names = {"vdot"};
  EXPECT_EQ(complaint(),
            "second.csv: targets: are vdot; those of first.csv are udot; --targets names those to "
            "tune on in every log");
}

TEST_F(TuneLogs, ALogGivenTwiceIsRefused) {
  problem_.logs[1] = problem_.logs[0];
  EXPECT_EQ(complaint(), "first.csv: is given twice: it would count twice");
}

TEST_F(TuneLogs, InputsMayDifferWhereNoSettingNamesThem) {
  problem_.logs[1].data.input_names = {"u", "thruster"};
  EXPECT_NO_THROW(problem_.validate());
  problem_.base.assign("terms", "row*u");
  EXPECT_NE(complaint().find("second.csv: terms: 'row*u': 'row' is no column"), std::string::npos)
      << complaint();
}

}  // namespace
}  // namespace kelpie::tune_logs_test
