// SPDX-License-Identifier: Apache-2.0
#include "study/tune.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <fstream>
#include <iterator>

#include "kelpie/core/error.hpp"
#include "study/constant_error.hpp"
#include "study/small_log.hpp"
#include "support.hpp"

namespace kelpie::tune_test {
namespace {

using testing::all_rows;
using testing::message_of;
using testing::small_log;
using testing::TemporaryFolder;

// The error of a toy learner: grows with γ's distance from 0.2, and with a full covariance.
double error_of(const ModelSettings& settings) {
  return 0.1 * std::abs(std::log(settings.axes.front().gamma / 0.2)) +
         (settings.shared.scaling == ScalingKind::full ? 0.05 : 0.0);
}

class Tune : public ::testing::Test {
 protected:
  study::TuneProblem problem(const std::vector<std::string>& searches) const {
    study::TuneProblem problem{
        .logs = {{data_, all_rows(data_.rows()), "all rows"}},
        .base = ModelSettings::from_preset("default", data_.target_names.size()),
        .space = {},
        .references = {}};
    problem.base.assign("warmup", "20");
    for (const std::string& text : searches) {
      problem.space.search(text);
    }
    problem.references = {{"base", problem.base}};
    return problem;
  }

  static study::TuneOptions toy() {
    study::TuneOptions options;
    options.candidates = 30;
    options.make_learner = [](const log::Dataset&, const ModelSettings& settings) {
      return std::make_unique<testing::ConstantError>(error_of(settings));
    };
    return options;
  }

  study::TuneResult run(const study::TuneProblem& problem, const study::TuneOptions& options,
                        const std::string& journal, std::size_t threads = 1) const {
    study::TuneJournal file(folder_ / journal, study::journal_header(problem, options));
    return study::tune(problem, options, file, *jobs::make_thread_executor(threads));
  }

  log::Dataset data_ = small_log(1200);
  TemporaryFolder folder_;
};

// Everything a result says, as one text to compare.
std::string text_of(const study::TuneResult& result) {
  std::string text;
  for (const auto& [name, value] : result.tuned.values()) {
    text += name + "=" + value + "\n";
  }
  for (const study::TunedAxis& axis : result.axes) {
    text += axis.name + " " + std::to_string(axis.score) + " " + std::to_string(axis.rung) + "\n";
  }
  for (const study::Evaluation& one : result.evaluations) {
    text += one.key.axis + " " + std::to_string(one.key.rung) + " " + one.key.settings + " " +
            std::to_string(one.result.score) + "\n";
  }
  return text;
}

TEST_F(Tune, BaselinesAreJudgedOnTheSameRows) {
  const study::TuneResult result = run(problem({"gamma=0.01:3:log"}), toy(), "journal");
  for (const study::TunedAxis& axis : result.axes) {
    EXPECT_LT(axis.all.mean, 0.05);
    EXPECT_GT(axis.all.mean, -0.5);
    EXPECT_GT(axis.all.least_squares, 0.5);
    EXPECT_LE(axis.all.least_squares, 1.0);
  }
}

TEST_F(Tune, ChoosesTheCandidateWithTheBestScore) {
  const study::TuneProblem searched = problem({"gamma=0.01:3:log"});
  const study::TuneResult result = run(searched, toy(), "journal");
  double nearest = HUGE_VAL;
  for (const study::Assignments& candidate : searched.space.candidates(1, 30)) {
    const double gamma = candidate.empty() ? 0.15 : std::stod(candidate.front().second);
    nearest = std::min(nearest, std::abs(std::log(gamma / 0.2)));
  }
  EXPECT_NEAR(std::abs(std::log(result.tuned.axes.front().gamma / 0.2)), nearest, 1e-9);
  EXPECT_EQ(result.axes.front().rung, 2U);
  EXPECT_GE(result.axes.front().score, result.axes.front().all.references.front());
}

TEST_F(Tune, EachRungKeepsAThirdAndTheBaseIsNeverDropped) {
  study::TuneProblem searched = problem({"gamma=0.1:0.4:log"});
  searched.base.assign("gamma", "3");  // worst of all
  searched.references.clear();
  const study::TuneResult result = run(searched, toy(), "journal");
  std::vector<std::size_t> on_rung(3, 0);
  std::size_t base_on_last = 0;
  for (const study::Evaluation& one : result.evaluations) {
    ++on_rung[one.key.rung];
    base_on_last +=
        one.key.rung == 2 && one.key.settings.find(" gamma=3 ") != std::string::npos ? 1 : 0;
  }
  EXPECT_EQ(on_rung, (std::vector<std::size_t>{30, 11, 5}));
  EXPECT_EQ(base_on_last, 1U);
}

TEST_F(Tune, ThreadsDoNotChangeTheResult) {
  data_ = small_log(1200, 2);
  const study::TuneProblem searched = problem({"gamma=0.01:3:log", "c=1:10"});
  const std::string one = text_of(run(searched, toy(), "one", 1));
  EXPECT_EQ(text_of(run(searched, toy(), "four", 4)), one);
  EXPECT_NE(one.find("gamma="), std::string::npos);
}

TEST_F(Tune, EqualScoresGoToTheCandidateDrawnFirst) {
  const study::TuneResult result =
      run(problem({"c=1:100:log"}), toy(), "journal", 3);  // no difference
  EXPECT_EQ(result.tuned.axes.front().c, OnlineSvrSettings{}.c) << "the base is the first";
}

TEST_F(Tune, StoppedAndResumedItEndsAsIfItHadNeverStopped) {
  const study::TuneProblem searched = problem({"gamma=0.01:3:log"});
  const std::string whole = text_of(run(searched, toy(), "whole"));
  study::TuneOptions stopping = toy();
  std::atomic<int> calls{0};
  stopping.keep_going = [&](double) { return ++calls < 150; };
  const study::TuneResult stopped = run(searched, stopping, "cut");
  EXPECT_TRUE(stopped.interrupted);
  EXPECT_LT(stopped.evaluations.size(), 30U);
  std::string journal;
  {
    std::ifstream file(folder_ / "cut");
    journal.assign(std::istreambuf_iterator<char>(file), {});
  }
  std::ofstream(folder_ / "cut") << journal.substr(0, journal.size() - 20);  // killed while writing
  EXPECT_EQ(text_of(run(searched, toy(), "cut")), whole);
}

TEST_F(Tune, AFinishedJournalIsNotEvaluatedAgain) {
  const study::TuneProblem searched = problem({"gamma=0.01:3:log"});
  const std::string first = text_of(run(searched, toy(), "journal"));
  study::TuneOptions none = toy();
  none.make_learner = [](const log::Dataset&,
                         const ModelSettings&) -> std::unique_ptr<OnlineRegressor> {
    throw Failure("nothing is left to evaluate");
  };
  EXPECT_EQ(text_of(run(searched, none, "journal")), first);
}

TEST_F(Tune, AJournalOfOtherValuesUnderTheSameNameIsRefused) {
  study::TuneProblem searched = problem({"gamma=0.01:3:log"});
  run(searched, toy(), "journal");
  searched.logs.front().data.targets.back() += 1e-9;
  EXPECT_NE(message_of<InputError>([&] { run(searched, toy(), "journal"); }).find("values"),
            std::string::npos);
}

TEST_F(Tune, SharedSettingsAreChosenForAllAxesTogether) {
  const study::TuneResult result = run(problem({"scaling=full,diagonal"}), toy(), "journal");
  EXPECT_EQ(result.tuned.shared.scaling, ScalingKind::diagonal);
}

TEST_F(Tune, WhatALearnerThrowsComesOutAfterAllThreadsHaveEnded) {
  study::TuneOptions options = toy();
  options.make_learner = [](const log::Dataset&,
                            const ModelSettings&) -> std::unique_ptr<OnlineRegressor> {
    throw Failure("no memory");
  };
  EXPECT_EQ(message_of<Failure>([&] { run(problem({"gamma=0.01:3:log"}), options, "journal", 4); }),
            "no memory");
}

TEST_F(Tune, FindsTheRightGammaForTheRealLearner) {
  data_ = small_log(3600);  // the first rung's rows are enough to have learned something
  for (std::size_t row = 0; row < data_.rows(); ++row) {
    data_.inputs[2 * row + 1] = std::cos(0.05 * static_cast<double>(row));
  }
  study::TuneProblem searched = problem({"gamma=0.00001,1,1000"});
  searched.base.assign("learner", "svr");
  searched.base.assign("terms", "none");
  searched.base.assign("buffer", "60");
  searched.base.assign("gamma", "1000");
  searched.base.assign("c", "10");
  searched.references = {{"base", searched.base}};
  study::TuneOptions options = study::TuneOptions{};
  options.candidates = 10;
  const study::TuneResult result = run(searched, options, "journal");
  EXPECT_EQ(result.tuned.axes.front().gamma, 1.0);
  EXPECT_GT(result.axes.front().score, result.axes.front().all.references.front() + 0.4);
}

TEST_F(Tune, RefusesNoCandidatesAndNoIterations) {
  study::TuneOptions options = toy();
  options.candidates = 0;
  EXPECT_NE(message_of<InputError>([&] { options.validate(); }).find("candidates"),
            std::string::npos);
  options = toy();
  options.most_iterations = NAN;
  EXPECT_NE(message_of<InputError>([&] { options.validate(); }).find("most_iterations"),
            std::string::npos);
}

}  // namespace
}  // namespace kelpie::tune_test
