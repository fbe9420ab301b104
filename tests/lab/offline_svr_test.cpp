// SPDX-License-Identifier: Apache-2.0
#include "lab/offline_svr.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "kelpie/core/error.hpp"
#include "lab/logs.hpp"
#include "support.hpp"
#include "svr/dual_problem.hpp"
#include "svr/smo_solver.hpp"

namespace kelpie::offline_svr_test {
namespace {

using testing::Log;

// The same training set through our own solver.
SvrFunction solved_by_smo(const Log& log, const AxisScaling& scaling,
                          const lab::OfflineSvrSettings& settings) {
  const SquaredExponential kernel(settings.gamma);
  SampleStore samples(2, log.rows.size());
  DualProblem problem(log.rows.size(), settings.epsilon, settings.c);
  std::vector<double> row(log.rows.size());
  for (const std::size_t i : log.rows) {
    const ScaledInput z = scaling.input.apply(log.view().input(i));
    kernel.row(as_span(z), samples, row);
    problem.add(std::span(row).first(samples.size()), 1.0,
                scaling.target.apply(log.view().target_of(i)));
    samples.push_back(as_span(z));
  }
  EXPECT_TRUE(SmoSolver(settings.tolerance, 10'000'000).solve(problem).converged);
  SvrFunction function({kernel, 2}, samples.size());
  function.assign(samples, problem.beta(), problem.kkt().bias());
  return function;
}

class Scalings : public ::testing::TestWithParam<ScalingKind> {};

TEST_P(Scalings, PredictsWhatOurOwnSolverDoes) {
  const Log log(1, 300);
  lab::OfflineSvrSettings settings;
  settings.scaling = GetParam();
  settings.gamma = 0.3;
  settings.c = 3.0;
  settings.tolerance = 1e-6;
  const lab::OfflineSvr svr(log.view(), settings);
  const SvrFunction ours = solved_by_smo(log, svr.scaling(), settings);
  RandomStream random(2, "probe");
  for (int i = 0; i < 200; ++i) {
    const std::vector<double> x{random.uniform(-2.0, 2.0), random.uniform(30.0, 70.0)};
    const double expected =
        svr.scaling().target.invert(ours(as_span(svr.scaling().input.apply(x))));
    ASSERT_NEAR(svr.predict(x), expected, 1e-4);
  }
}

INSTANTIATE_TEST_SUITE_P(OfflineSvr, Scalings,
                         ::testing::Values(ScalingKind::full, ScalingKind::diagonal));

TEST(OfflineSvr, ReadsNoRowThatIsNotItsOwn) {
  Log log(3, 200);
  std::vector<std::size_t> even;
  for (std::size_t i = 0; i < 200; i += 2) {
    even.push_back(i);
  }
  log.rows = even;
  const double before = lab::OfflineSvr(log.view(), {}).predict(std::vector{0.5, 50.0});
  log.poison_all_but(even);
  EXPECT_EQ(lab::OfflineSvr(log.view(), {}).predict(std::vector{0.5, 50.0}), before);
}

TEST(OfflineSvr, TrainsInSilence) {
  ::testing::internal::CaptureStdout();
  const Log log(4, 50);
  const lab::OfflineSvr svr(log.view(), {});
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
}

TEST(OfflineSvr, SaysWhatIsWrongWithItsTrainingRows) {
  Log log(5, 50);
  const auto message = [&](const lab::OfflineSvrSettings& settings) {
    return testing::message_of<InputError>([&] { return lab::OfflineSvr(log.view(), settings); });
  };
  EXPECT_EQ(message({.gamma = 0.0}), "gamma: 0 is out of range; it has to be > 0");
  log.x[14] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(message({}), "rows: row 7 holds a value that is not finite");
  for (std::size_t i = 0; i < 50; ++i) {
    log.x[2 * i] = 1.0;
    log.x[2 * i + 1] = static_cast<double>(i);
  }
  EXPECT_EQ(message({}),
            "inputs: number 1 is constant over the training rows, or a combination of those before "
            "it");
  log.rows.resize(1);
  EXPECT_EQ(message({}), "rows: 1 given; there have to be 2 or more");
}

}  // namespace
}  // namespace kelpie::offline_svr_test
