// SPDX-License-Identifier: Apache-2.0
#include "svr/smo_solver.hpp"

#include <gtest/gtest.h>
#include <libsvm/svm.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "problems.hpp"
#include "support.hpp"

namespace kelpie::smo_solver_test {
namespace {

using testing::Problem;

constexpr int kBound = 10'000'000;

// What LIBSVM makes of a problem: the same dual, by another hand.
struct Reference {
  double objective = 0.0;
  std::vector<double> predicted;
};

Reference solve_with_libsvm(const Problem& problem, double tolerance) {
  svm_set_print_string_function([](const char*) {});
  const std::size_t n = problem.x.size();
  std::vector<std::vector<svm_node>> nodes(n);
  std::vector<svm_node*> rows;
  std::vector<double> y = problem.y;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < problem.x[i].size(); ++k) {
      nodes[i].push_back({static_cast<int>(k) + 1, problem.x[i][k]});
    }
    nodes[i].push_back({-1, 0.0});
    rows.push_back(nodes[i].data());
  }
  const svm_problem input{static_cast<int>(n), y.data(), rows.data()};
  svm_parameter parameter{};
  parameter.svm_type = EPSILON_SVR;
  parameter.kernel_type = RBF;
  parameter.gamma = problem.gamma;
  parameter.C = problem.c;
  parameter.p = problem.epsilon;
  parameter.eps = 2.0 * tolerance;  // LIBSVM stops at upper − lower, twice our gap
  parameter.cache_size = 64;
  parameter.shrinking = 0;
  const auto release = [](svm_model* model) { svm_free_and_destroy_model(&model); };
  const std::unique_ptr<svm_model, decltype(release)> model(svm_train(&input, &parameter), release);

  Reference reference;
  std::vector<double> beta(n, 0.0);
  for (int s = 0; s < model->l; ++s) {
    beta[static_cast<std::size_t>(model->sv_indices[s] - 1)] = model->sv_coef[0][s];
  }
  for (std::size_t i = 0; i < n; ++i) {
    double expansion = 0.0;
    for (std::size_t j = 0; j < n; ++j) {
      expansion += beta[j] == 0.0 ? 0.0 : beta[j] * testing::kernel(problem, i, j);
    }
    reference.objective +=
        beta[i] * (0.5 * expansion - problem.y[i]) + problem.epsilon * std::abs(beta[i]);
    reference.predicted.push_back(svm_predict(model.get(), rows[i]));
  }
  return reference;
}

void expect_feasible(const DualProblem& dual) {
  EXPECT_NEAR(testing::sum_of(dual.beta()), 0.0,
              1e-10 * dual.loss().c * static_cast<double>(dual.size()));
  for (const double beta : dual.beta()) {
    EXPECT_LE(std::abs(beta), dual.loss().c);
  }
}

// The last of 300 problems have up to 600 samples.
void expect_agreement_with_libsvm(int trials) {
  constexpr double kTolerance = 1e-7;
  RandomStream random(11, "libsvm");
  int unique = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const std::size_t n = trial < 290 ? 2 + random.below(trial < 240 ? 40 : 150)
                                      : 300 + 30 * static_cast<std::size_t>(trial - 289);
    const Problem problem = testing::random_problem(random, n);
    SCOPED_TRACE(::testing::Message()
                 << "trial " << trial << ", n " << n << ", gamma " << problem.gamma << ", C "
                 << problem.c << ", eps " << problem.epsilon);
    const Reference reference = solve_with_libsvm(problem, kTolerance);
    DualProblem dual = testing::dual_of(problem);
    const SolveReport report = SmoSolver(kTolerance, kBound).solve(dual);
    ASSERT_TRUE(report.converged) << report.kkt_gap;
    expect_feasible(dual);
    const double scale = std::max(1.0, std::abs(reference.objective));
    EXPECT_NEAR(objective(dual), reference.objective, 1e-6 * scale);
    // f is unique up to b, and b is unique where a support vector is free.
    const Kkt kkt = dual.kkt();
    const bool bias_is_unique = kkt.upper - kkt.lower < 1e-5;
    unique += bias_is_unique ? 1 : 0;
    double largest = 0.0;
    for (std::size_t i = 0; bias_is_unique && i < n; ++i) {
      const double predicted = problem.y[i] - dual.gradient()[i] + kkt.bias();
      largest = std::max(largest, std::abs(predicted - reference.predicted[i]));
    }
    EXPECT_LT(largest, 1e-4 * std::max(1.0, problem.c));
  }
  EXPECT_GT(unique, 30);
}

TEST(SmoSolver, AgreesWithLibsvmOnHundredsOfProblems) {
  expect_agreement_with_libsvm(291);
}

TEST(NightlySmoSolver, AgreesWithLibsvmOnLargeProblems) {
  expect_agreement_with_libsvm(300);
}

TEST(SmoSolver, WarmStartReachesWhatAColdStartDoes) {
  RandomStream random(12, "warm");
  Problem problem = testing::random_problem(random, 120);
  problem.gamma = 0.5;
  problem.c = 1.0;
  problem.epsilon = 0.1;
  DualProblem warm(problem.x.size(), problem.epsilon, problem.c);
  SmoSolver solver(1e-8, kBound);
  std::vector<std::size_t> members;
  int last_iterations = 0;
  for (std::size_t i = 0; i < problem.x.size(); ++i) {
    testing::add_sample(warm, problem, i, members);
    members.push_back(i);
    last_iterations = solver.solve(warm).iterations;
    expect_feasible(warm);
  }
  DualProblem cold = testing::dual_of(problem);
  const SolveReport from_zero = solver.solve(cold);
  EXPECT_NEAR(objective(warm), objective(cold), 1e-9 * std::abs(objective(cold)));
  EXPECT_LT(last_iterations, from_zero.iterations);
}

TEST(SmoSolver, StopsAtItsBoundAndSaysSo) {
  RandomStream random(13, "bound");
  Problem problem = testing::random_problem(random, 100);
  problem.epsilon = 0.0;
  problem.c = 100.0;
  DualProblem dual = testing::dual_of(problem);
  const SolveReport stopped = SmoSolver(1e-9, 20).solve(dual);
  EXPECT_EQ(stopped.iterations, 20);
  EXPECT_FALSE(stopped.converged);
  EXPECT_GT(stopped.kkt_gap, 1e-9);
  expect_feasible(dual);
  EXPECT_TRUE(SmoSolver(1e-9, kBound).solve(dual).converged);  // and goes on from there
}

TEST(SmoSolver, EndsWhereTheToleranceIsBelowRounding) {
  RandomStream random(3, "rounding");
  for (int trial = 0; trial < 60; ++trial) {
    DualProblem dual = testing::dual_of(testing::random_problem(random, 2 + random.below(40)));
    const SolveReport report = SmoSolver(1e-17, kBound).solve(dual);
    EXPECT_TRUE(report.converged) << report.kkt_gap;
    EXPECT_LT(report.kkt_gap, 1e-9);
  }
}

TEST(SmoSolver, TrivialProblems) {
  SmoSolver solver(1e-9, 100);
  DualProblem dual(2, 0.1, 1.0);
  EXPECT_TRUE(solver.solve(dual).converged);
  dual.add({}, 1.0, 3.0);
  EXPECT_TRUE(solver.solve(dual).converged);
  EXPECT_EQ(dual.beta()[0], 0.0);  // Σβ = 0 leaves a lone sample none
  EXPECT_DOUBLE_EQ(dual.kkt().bias(), 3.0);
  const double same_point = 1.0;
  dual.add({&same_point, 1}, 1.0, -3.0);  // contradicts the first: both end at the bound
  EXPECT_TRUE(solver.solve(dual).converged);
  EXPECT_EQ(dual.beta()[0], 1.0);
  EXPECT_EQ(dual.beta()[1], -1.0);
}

}  // namespace
}  // namespace kelpie::smo_solver_test
