// SPDX-License-Identifier: Apache-2.0
#include "svr/dual_problem.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "problems.hpp"
#include "svr/smo_solver.hpp"

namespace kelpie::dual_problem_test {
namespace {

using testing::Problem;

constexpr double kTolerance = 1e-6;

// The table of DualProblem's header, line by line, with the problem's own best bias.
double largest_violation(const DualProblem& dual) {
  const double bias = dual.kkt().bias();
  double largest = 0.0;
  for (std::size_t i = 0; i < dual.size(); ++i) {
    const double beta = dual.beta()[i];
    const double e = dual.gradient()[i] - bias;
    double violation = 0.0;
    if (beta == 0.0) {
      violation = std::abs(e) - dual.loss().epsilon;
    } else if (beta == dual.loss().c) {
      violation = dual.loss().epsilon - e;
    } else if (beta == -dual.loss().c) {
      violation = e + dual.loss().epsilon;
    } else {
      violation = std::abs(e - std::copysign(dual.loss().epsilon, beta));
    }
    largest = std::max(largest, violation);
  }
  return largest;
}

TEST(DualProblem, GapIsTheLargestViolationOfTheTable) {
  RandomStream random(21, "table");
  for (int trial = 0; trial < 200; ++trial) {
    const Problem problem = testing::random_problem(random, 2 + random.below(30));
    DualProblem dual = testing::dual_of(problem);
    SmoSolver(1e-12, static_cast<int>(1 + random.below(40))).solve(dual);  // somewhere on the way
    EXPECT_NEAR(dual.kkt().gap(), largest_violation(dual), 1e-9 * std::max(1.0, problem.c));
  }
}

TEST(DualProblem, DescentNeverRaisesTheObjectiveAndKeepsTheConstraints) {
  RandomStream random(22, "descent");
  for (int trial = 0; trial < 100; ++trial) {
    const Problem problem = testing::random_problem(random, 2 + random.below(20));
    DualProblem dual = testing::dual_of(problem);
    for (int step = 0; step < 50; ++step) {
      const std::size_t i = random.below(dual.size());
      const std::size_t j = random.below(dual.size());
      if (i == j || !(dual.lower_bound(i) > dual.upper_bound(j))) {
        continue;
      }
      const double before = objective(dual);
      dual.descend(i, j);
      const double after = objective(dual);
      EXPECT_LE(after, before + 1e-9 * std::max(1.0, std::abs(before)));
      // Exact along the pair: nothing is left to gain in this direction.
      EXPECT_LE(dual.lower_bound(i) - dual.upper_bound(j), 1e-6 * std::max(1.0, problem.c));
      EXPECT_NEAR(testing::sum_of(dual.beta()), 0.0, 1e-10 * problem.c);
    }
  }
}

TEST(DualProblem, ResidualsStayThoseOfTheirBetaWhileSamplesComeAndGo) {
  RandomStream random(23, "churn");
  for (int trial = 0; trial < 30; ++trial) {
    const Problem problem = testing::random_problem(random, 200);
    DualProblem dual(40, problem.epsilon, problem.c);
    std::vector<std::size_t> members;
    for (std::size_t i = 0; i < problem.x.size(); ++i) {
      while (dual.size() == 40 || (dual.size() > 0 && random.below(10) == 0)) {
        const std::size_t leaving = random.below(dual.size());
        dual.remove(leaving);
        members[leaving] = members.back();
        members.pop_back();
        ASSERT_NEAR(testing::sum_of(dual.beta()), 0.0, 1e-9 * problem.c);
      }
      testing::add_sample(dual, problem, i, members);
      members.push_back(i);
      SmoSolver(kTolerance, 1'000'000).solve(dual);
      for (std::size_t a = 0; a < members.size(); ++a) {
        double expected = problem.y[members[a]];
        for (std::size_t b = 0; b < members.size(); ++b) {
          expected -= testing::kernel(problem, members[a], members[b]) * dual.beta()[b];
        }
        ASSERT_NEAR(dual.gradient()[a], expected, 1e-9 * std::max(1.0, problem.c));
      }
      EXPECT_NEAR(kkt_afresh(dual).gap(), dual.kkt().gap(), 1e-9 * std::max(1.0, problem.c));
    }
  }
}

TEST(DualProblem, AWeightGoesToTheMostSimilarSampleWithRoom) {
  DualProblem dual(3, 0.0, 1.0);
  const std::vector<double> far{0.1};
  const std::vector<double> near{0.2, 0.9};
  dual.add({}, 1.0, 1.0);
  dual.add(far, 1.0, -1.0);
  dual.descend(0, 1);
  const double weight = dual.beta()[0];
  ASSERT_GT(weight, 0.0);
  dual.add(near, 1.0, 0.0);  // similar to sample 1
  dual.remove(1);
  EXPECT_DOUBLE_EQ(dual.beta()[1], -weight);
  EXPECT_DOUBLE_EQ(dual.beta()[0], weight);
}

}  // namespace
}  // namespace kelpie::dual_problem_test
