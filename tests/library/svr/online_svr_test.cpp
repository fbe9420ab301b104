// SPDX-License-Identifier: Apache-2.0
#include "kelpie/svr/online_svr.hpp"
#include "kelpie/svr/resources.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "kelpie/core/error.hpp"
#include "learner/streams.hpp"
#include "svr/sample_collector.hpp"

namespace kelpie::online_svr_test {
namespace {

using testing::r_squared_on;
using testing::Sample;
using testing::wandering_stream;

double sum(std::span<const double> values) {
  double total = 0.0;
  for (const double value : values) {
    total += value;
  }
  return total;
}

// d(x_i) from its definition, eq. (8) with the Gaussian and H = h I.
double density_by_definition(const SampleStore& samples, std::size_t i, double h) {
  std::vector<double> a(samples.dimension());
  std::vector<double> b(samples.dimension());
  samples.get(i, a);
  double density = 0.0;
  for (std::size_t j = 0; j < samples.size(); ++j) {
    samples.get(j, b);
    double square = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) {
      square += (a[k] - b[k]) * (a[k] - b[k]) / (h * h);
    }
    density += std::exp(-0.5 * square);
  }
  return density / (static_cast<double>(samples.size()) *
                    std::pow(h, static_cast<double>(samples.dimension())));
}

OnlineSvrSettings random_settings() {
  OnlineSvrSettings settings;
  settings.solver = *rc::gen::element(SolverKind::path, SolverKind::smo);
  settings.storage = *rc::gen::element(Storage::float64, Storage::float32);
  settings.buffer = *rc::gen::inRange(2, 60);
  settings.epsilon = *rc::gen::element(0.0, 0.001, 0.05, 0.3);
  settings.c = *rc::gen::element(0.1, 1.0, 10.0);
  settings.gamma = *rc::gen::element(0.01, 0.3, 3.0);
  settings.anchors = *rc::gen::inRange(1, 20);
  settings.outlier = *rc::gen::element(OutlierRule::none, OutlierRule::iqr, OutlierRule::robust);
  settings.outlier_factor = *rc::gen::element(1.0, 8.0);
  settings.forget = *rc::gen::element(ForgetRule::fifo, ForgetRule::paper, ForgetRule::age);
  settings.bandwidth = *rc::gen::element(0.0, 0.2);
  return settings;
}

RC_GTEST_PROP(OnlineSvr, EveryUpdateKeepsItsPromises, ()) {
  const OnlineSvrSettings settings = random_settings();
  const auto seed = *rc::gen::inRange<std::uint64_t>(0, 1000);
  const auto repeat = *rc::gen::inRange<std::size_t>(1, 4);  // duplicated points
  OnlineSvr learner(2, settings);
  const double rounding = settings.storage == Storage::float64 ? 1e-9 : 1e-6 * settings.c;
  for (const Sample& sample : wandering_stream(seed, 120, 0.3)) {
    for (std::size_t copy = 0; copy < repeat; ++copy) {
      const double before = learner.predict(sample.z);
      const Decision decision = learner.update(sample.z, sample.y, sample.t);
      RC_ASSERT(std::abs(decision.prediction.value - before) <= 1e-9 * settings.c);
      const DualProblem& problem = learner.buffer().problem();
      const Tally tally = learner.status().tally;
      RC_ASSERT(decision.kkt_gap <= settings.tolerance);
      RC_ASSERT(std::abs(sum(problem.beta())) <= 1e-9 * settings.c);
      RC_ASSERT(
          std::ranges::all_of(problem.beta(), [&](double b) { return std::abs(b) <= settings.c; }));
      RC_ASSERT(kkt_afresh(problem).gap() <= settings.tolerance + rounding);
      RC_ASSERT(learner.buffer().size() <= static_cast<std::size_t>(settings.buffer));
      RC_ASSERT(tally.accepted == static_cast<std::int64_t>(learner.buffer().size()) +
                                      tally.outliers + tally.forgotten + tally.released);
      RC_ASSERT(learner.status().ready);
    }
  }
  const double h = settings.bandwidth > 0.0
                       ? settings.bandwidth
                       : KernelDensity::scott(2, static_cast<std::size_t>(settings.buffer));
  for (std::size_t i = 0; i < learner.buffer().size(); ++i) {
    const double expected = density_by_definition(learner.buffer().samples(), i, h);
    RC_ASSERT(std::abs(learner.buffer().density().at(i) - expected) <= 1e-9 * expected);
  }
}

TEST(OnlineSvr, LearnsAFunctionFromAColdStart) {
  OnlineSvrSettings settings;
  settings.buffer = 150;
  settings.gamma = 0.5;
  settings.epsilon = 0.02;
  OnlineSvr learner(2, settings);
  for (const Sample& sample : wandering_stream(1, 1500)) {
    learner.update(sample.z, sample.y, sample.t);
  }
  EXPECT_GT(r_squared_on(learner, wandering_stream(2, 1000, 0.0)), 0.98);
}

// "Keep support vectors only" would drop a lone first sample, and every one after it.
TEST(OnlineSvr, TheBufferBeginsToFillEvenWhereNothingHasAWeight) {
  OnlineSvrSettings settings;
  settings.epsilon = 0.5;
  settings.anchors = 10;
  OnlineSvr learner(1, settings);
  for (int i = 0; i < 30; ++i) {
    const double z = 0.3 * i;
    learner.update({&z, 1}, 0.01 * i, i);
  }
  EXPECT_EQ(learner.status().support_vectors, 0);
  EXPECT_EQ(learner.status().buffer, 10);
}

TEST(OnlineSvr, ABadSampleIsTurnedAwayAndChangesNothing) {
  OnlineSvr learner(2, OnlineSvrSettings{});
  for (const Sample& sample : wandering_stream(3, 50)) {
    learner.update(sample.z, sample.y, sample.t);
  }
  const std::vector<double> here{0.1, 0.2};
  const double before = learner.predict(here);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(learner.update(std::vector{nan, 0.0}, 0.0, 99.0).verdict, Verdict::invalid);
  EXPECT_EQ(learner.update(here, infinity, 99.0).verdict, Verdict::invalid);
  EXPECT_TRUE(std::isnan(learner.update(here, nan, 99.0).prediction.value));
  EXPECT_EQ(learner.update(here, 0.0, nan).verdict, Verdict::invalid);
  EXPECT_EQ(learner.update(std::vector{1.0}, 0.0, 99.0).verdict, Verdict::invalid);
  EXPECT_EQ(learner.status().tally.invalid, 5);
  EXPECT_EQ(learner.predict(here), before);
}

// When the solver runs into its bound the model out of tolerance stays out of service, and later
// steps go on with the work.
TEST(OnlineSvr, ServesTheOldModelUntilTheNewOneIsWithinTolerance) {
  OnlineSvrSettings settings;
  settings.epsilon = 0.0;
  settings.c = 100.0;
  settings.gamma = 0.2;
  settings.tolerance = 1e-6;
  settings.solver = SolverKind::smo;
  settings.max_iterations = 3;
  settings.outlier = OutlierRule::none;
  OnlineSvr learner(2, settings);
  const std::vector<double> here{0.1, 0.2};
  int kept = 0;
  for (const Sample& sample : wandering_stream(4, 60)) {
    const double before = learner.predict(here);
    const bool ready = learner.status().ready;
    const Decision decision = learner.update(sample.z, sample.y, sample.t);
    if (ready && !decision.published) {
      ++kept;
      EXPECT_EQ(learner.predict(here), before);
    }
    EXPECT_LE(learner.status().kkt_gap, settings.tolerance);
  }
  EXPECT_GT(kept, 10);
  EXPECT_GT(learner.status().tally.rejected_by_tolerance, 10);
  const Sample last = wandering_stream(4, 60).back();
  bool published = false;
  for (int step = 0; step < 100'000 && !published; ++step) {
    published = learner.update(last.z, last.y, last.t).published;
  }
  EXPECT_TRUE(published);
}

// A budget cuts the work of one update into several; none of it is lost, and nothing half done is
// ever served.
TEST(OnlineSvr, KeepsToItsBudgetAndFinishesLater) {
  OnlineSvrSettings settings;
  settings.buffer = 40;
  settings.gamma = 0.5;
  settings.epsilon = 0.01;
  for (const SolverKind solver : {SolverKind::path, SolverKind::smo}) {
    settings.solver = solver;
    OnlineSvr learner(2, settings);
    learner.limit(Budget(2));
    const std::vector<double> here{0.1, 0.2};
    for (const Sample& sample : wandering_stream(8, 4000)) {
      const double before = learner.predict(here);
      const bool ready = learner.status().ready;
      const Decision decision = learner.update(sample.z, sample.y, sample.t);
      const Tally tally = learner.status().tally;
      ASSERT_LE(decision.iterations, 2);
      ASSERT_LE(learner.status().kkt_gap, settings.tolerance);
      ASSERT_LE(learner.buffer().size(), 41U);
      ASSERT_EQ(tally.accepted, static_cast<std::int64_t>(learner.buffer().size()) +
                                    tally.outliers + tally.forgotten + tally.released);
      if (ready && !decision.published) {
        ASSERT_EQ(learner.predict(here), before);
      }
    }
    EXPECT_GT(learner.status().tally.unfinished, 50);
    EXPECT_GT(learner.status().tally.crowded_out, 50);
    EXPECT_GT(learner.status().tally.forgotten, 2);
    learner.limit(Budget());
    const Sample last = wandering_stream(8, 4000).back();
    EXPECT_FALSE(learner.update(last.z, last.y, last.t).unfinished);
    EXPECT_LE(kkt_afresh(learner.buffer().problem()).gap(), settings.tolerance);
  }
}

// Eight, so that the model in service gets no older; afterwards they are learned all together.
TEST(OnlineSvr, SamplesWaitForWorkThatIsLeftUndone) {
  OnlineSvrSettings settings;
  settings.buffer = 40;
  OnlineSvr learner(2, settings);
  const auto update = [&](int i) {
    const std::vector<double> z{0.8 * i, 0.0};  // in places of their own
    return learner.update(z, std::sin(i), i);
  };
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(update(i).published);
  }
  const double before = learner.predict(std::vector<double>{4.0, 0.0});
  learner.limit(Budget(0));
  for (int i = 10; i < 25; ++i) {
    const Decision decision = update(i);
    ASSERT_TRUE(decision.unfinished);
    ASSERT_EQ(decision.verdict, i <= 18 ? Verdict::accepted : Verdict::crowded_out) << i;
  }
  EXPECT_EQ(learner.predict(std::vector<double>{4.0, 0.0}), before);
  EXPECT_TRUE(learner.unfinished());
  learner.limit(Budget());
  EXPECT_TRUE(update(25).published);
  EXPECT_FALSE(learner.unfinished());
  EXPECT_EQ(learner.buffer().size(), 20U);
  EXPECT_LT(kkt_afresh(learner.buffer().problem()).gap(), 1e-9);
}

TEST(OnlineSvr, AsksTheCallersClock) {
  OnlineSvr learner(2, OnlineSvrSettings{});
  int asked = 0;
  const auto expired = [](void* count) { return ++*static_cast<int*>(count) % 5 == 0; };
  learner.limit(Budget(1'000'000, expired, &asked));
  for (const Sample& sample : wandering_stream(9, 200)) {
    learner.update(sample.z, sample.y, sample.t);
  }
  EXPECT_GT(asked, 100);
  EXPECT_GT(learner.status().tally.unfinished, 10);
  EXPECT_TRUE(learner.status().ready);
}

TEST(OnlineSvr, NeverServesTheTornModelOfAPruning) {
  OnlineSvrSettings settings;
  settings.buffer = 25;  // forgetting takes support vectors at nearly every step
  settings.gamma = 0.5;
  settings.epsilon = 0.01;
  settings.outlier = OutlierRule::none;
  OnlineSvr learner(2, settings);
  const std::vector<Sample> stream = wandering_stream(5, 600);
  const std::vector<Sample> held_out = wandering_stream(6, 200, 0.0);
  for (std::size_t i = 0; i < stream.size(); ++i) {
    learner.update(stream[i].z, stream[i].y, stream[i].t);
    if (i > 200) {
      ASSERT_GT(r_squared_on(learner, held_out), 0.5) << i;
    }
  }
  EXPECT_GT(learner.status().tally.forgotten, 100);
}

TEST(OnlineSvr, IsTheSameLearnerForTheSameStream) {
  OnlineSvr a(2, OnlineSvrSettings{});
  OnlineSvr b(2, OnlineSvrSettings{});
  for (const Sample& sample : wandering_stream(7, 300)) {
    const Decision one = a.update(sample.z, sample.y, sample.t);
    const Decision other = b.update(sample.z, sample.y, sample.t);
    ASSERT_EQ(one.prediction.value, other.prediction.value);
    ASSERT_EQ(one.iterations, other.iterations);
  }
}

TEST(OnlineSvr, RefusesSettingsThatMakeNoSense) {
  OnlineSvrSettings settings;
  settings.buffer = 0;
  EXPECT_THROW(OnlineSvr(2, settings), InputError);
  settings = {};
  settings.epsilon = -0.1;
  EXPECT_THROW(OnlineSvr(2, settings), InputError);
  settings = {};
  settings.gamma = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(OnlineSvr(2, settings), InputError);
}

}  // namespace
}  // namespace kelpie::online_svr_test
