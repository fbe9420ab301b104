// SPDX-License-Identifier: Apache-2.0
#include "kelpie/svr/path_solver.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "problems.hpp"

namespace kelpie {
namespace {

using testing::Problem;

constexpr int kBound = 10'000'000;

TEST(PathSolver, AgreesWithSmoOnRandomProblems) {
  RandomStream random(21, "path");
  int fallbacks = 0;
  long steps = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    const std::size_t n = 2 + random.below(trial < 900 ? 40 : 200);
    const Problem problem = testing::random_problem(random, n);
    SCOPED_TRACE(::testing::Message()
                 << "trial " << trial << ", n " << n << ", gamma " << problem.gamma << ", C "
                 << problem.c << ", eps " << problem.epsilon);
    DualProblem path(n, problem.epsilon, problem.c);
    PathSolver solver(n, 1e-7, kBound);
    std::vector<std::size_t> members;
    for (std::size_t i = 0; i < n; ++i) {
      testing::add_sample(path, problem, i, members);
      members.push_back(i);
      const SolveReport report = solver.solve(path);
      steps += report.iterations;
      fallbacks += report.fell_back ? 1 : 0;
      if (report.fell_back) printf("fell back trial %d i %zu eps %g C %g gamma %g\n", trial, i, problem.epsilon, problem.c, problem.gamma);
      ASSERT_TRUE(report.converged) << report.kkt_gap << " at " << i;
    }
    EXPECT_LE(path.kkt_afresh().gap(), 1e-7);
    DualProblem smo = testing::dual_of(problem);
    SmoSolver(1e-8, kBound).solve(smo);
    EXPECT_NEAR(path.objective(), smo.objective(), 1e-6 * std::max(1.0, std::abs(smo.objective())));
  }
  printf("fallbacks %d steps %ld\n", fallbacks, steps);
}

}  // namespace
}  // namespace kelpie
