// SPDX-License-Identifier: Apache-2.0
#include "svr/path_solver.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "problems.hpp"

namespace kelpie::path_solver_test {
namespace {

using testing::Problem;

constexpr int kBound = 10'000'000;

// A dual problem over some of a problem's samples, with the solver that keeps it at its optimum.
class Buffer {
 public:
  Buffer(const Problem& problem, std::size_t capacity, double ridge = 0.0)
      : problem_(problem),
        ridge_(ridge),
        scale_(std::abs(
            *std::ranges::max_element(problem.y, {}, [](double y) { return std::abs(y); }))),
        dual_(capacity, problem.epsilon, problem.c),
        solver_(capacity, 1e-7 * std::max(scale_, 1e-300), kBound) {}

  void add(std::size_t sample) {
    collect(sample);
    count(solver_.solve(dual_));
  }
  // Into the problem only: to be solved by whoever comes next.
  void collect(std::size_t sample) {
    std::vector<double> row;
    row.reserve(members_.size());
    for (const std::size_t j : members_) {
      row.push_back(testing::kernel(problem_, sample, j));
    }
    dual_.add(row, 1.0 + ridge_, problem_.y[sample]);
    members_.push_back(sample);
  }
  void remove(std::size_t i) {
    Budget budget;
    count(solver_.release(dual_, i, budget));
    EXPECT_EQ(dual_.beta()[i], 0.0);
    dual_.remove(i);
    solver_.removed(dual_, i);
    members_[i] = members_.back();
    members_.pop_back();
    count(solver_.solve(dual_));
  }
  double predict(const std::vector<double>& x) const {
    Problem with = problem_;
    with.x.push_back(x);
    double f = dual_.kkt().bias();
    for (std::size_t i = 0; i < members_.size(); ++i) {
      f += dual_.beta()[i] * testing::kernel(with, with.x.size() - 1, members_[i]);
    }
    return f;
  }

  DualProblem& dual() { return dual_; }
  PathSolver& solver() { return solver_; }
  const std::vector<std::size_t>& members() const { return members_; }
  std::size_t size() const { return members_.size(); }
  int fallbacks() const { return fallbacks_; }
  /// The KKT gap on fresh residuals, as a share of the largest target.
  double gap() const { return kkt_afresh(dual_).gap() / std::max(scale_, 1e-300); }

 private:
  void count(const SolveReport& report) {
    EXPECT_TRUE(report.converged) << report.kkt_gap;
    fallbacks_ += report.fell_back ? 1 : 0;
  }

  const Problem& problem_;
  double ridge_;
  double scale_;
  DualProblem dual_;
  PathSolver solver_;
  std::vector<std::size_t> members_;
  int fallbacks_ = 0;
};

::testing::Message about(int trial, const Problem& problem) {
  return ::testing::Message() << "trial " << trial << ", n " << problem.x.size() << ", gamma "
                              << problem.gamma << ", C " << problem.c << ", eps "
                              << problem.epsilon;
}

Problem smooth_problem(std::uint64_t seed, std::size_t n) {
  RandomStream random(seed, "smooth");
  Problem problem = testing::random_problem(random, n);
  problem.gamma = 0.5;
  problem.c = 5.0;
  problem.epsilon = 0.1;
  return problem;
}

TEST(PathSolver, ReachesTheSameOptimumAsSmoOnAThousandProblems) {
  RandomStream random(21, "path");
  for (int trial = 0; trial < 1000; ++trial) {
    const Problem problem =
        testing::random_problem(random, 2 + random.below(trial < 900 ? 40 : 150));
    SCOPED_TRACE(about(trial, problem));
    Buffer buffer(problem, problem.x.size());
    for (std::size_t i = 0; i < problem.x.size(); ++i) {
      buffer.add(i);
    }
    ASSERT_LE(buffer.gap(), 1e-8);
    EXPECT_EQ(buffer.fallbacks(), 0);
    EXPECT_NEAR(testing::sum_of(buffer.dual().beta()), 0.0,
                1e-11 * problem.c * static_cast<double>(problem.x.size()));
    DualProblem smo = testing::dual_of(problem);
    ASSERT_TRUE(SmoSolver(1e-8, kBound).solve(smo).converged);
    const double scale = std::max(1.0, std::abs(objective(smo)));
    EXPECT_NEAR(objective(buffer.dual()), objective(smo), 1e-6 * scale);
    const Kkt kkt = smo.kkt();
    for (std::size_t i = 0; kkt.upper - kkt.lower < 1e-6 && i < problem.x.size(); ++i) {
      const double path = problem.y[i] - buffer.dual().gradient()[i] + buffer.dual().kkt().bias();
      EXPECT_NEAR(path, problem.y[i] - smo.gradient()[i] + kkt.bias(), 1e-5 * (1.0 + problem.c));
    }
  }
}

// From empty to full and back, in any order, with all that makes active-set methods stumble.
TEST(PathSolver, StaysExactWhileHostileSamplesComeAndGo) {
  RandomStream random(31, "hostile");
  int operations = 0;
  int fallbacks = 0;
  for (int trial = 0; trial < 200; ++trial) {
    Problem problem = testing::random_problem(random, 100);
    problem.gamma = std::pow(10.0, random.uniform(-4.0, 3.0));
    problem.c = std::pow(10.0, random.uniform(-3.0, 6.0));
    if (trial % 3 == 0) {
      const double scale = std::pow(10.0, random.uniform(-6.0, 6.0));
      problem.epsilon *= scale;
      problem.c *= scale;
      std::ranges::for_each(problem.y, [&](double& y) { y *= scale; });
    }
    SCOPED_TRACE(about(trial, problem));
    Buffer buffer(problem, 50, trial % 2 == 0 ? 0.0 : 1e-9);
    bool filling = true;
    for (int operation = 0; operation < 250; ++operation) {
      filling = buffer.size() == 0 || (buffer.size() < 50 && filling && random.below(60) != 0) ||
                (!filling && random.below(60) == 0);
      if (buffer.size() == 0 || (buffer.size() < 50 && random.below(10) < (filling ? 9U : 2U))) {
        buffer.add(random.below(problem.x.size()));
      } else {
        buffer.remove(random.below(buffer.size()));
      }
      ASSERT_LE(buffer.gap(), 1e-6) << operation;
      ++operations;
    }
    fallbacks += buffer.fallbacks();
  }
  EXPECT_EQ(operations, 50'000);
  EXPECT_LE(fallbacks, 5);
}

TEST(PathSolver, ForgettingASampleAndAddingItAgainReturnsToTheSameModel) {
  const Problem problem = smooth_problem(5, 80);
  Buffer buffer(problem, 80);
  for (std::size_t i = 0; i < 80; ++i) {
    buffer.add(i);
  }
  const std::vector<double> probe(problem.x.front().size(), 0.3);
  const double before = buffer.predict(probe);
  for (int round = 0; round < 40; ++round) {
    const std::size_t sample = buffer.members().front();
    buffer.remove(0);
    buffer.add(sample);
    EXPECT_NEAR(buffer.predict(probe), before, 1e-9);
  }
}

// In slices of a few steps, each of which leaves β within its bounds.
TEST(PathSolver, ARestartInSlicesEndsAtTheOptimum) {
  const Problem problem = smooth_problem(8, 80);
  DualProblem dual = testing::dual_of(problem);
  PathSolver solver(80, 1e-3, kBound);
  int slices = 0;
  std::optional<SolveReport> report;
  while (!report && ++slices < 10'000) {
    report = solver.restart(dual, Budget(3));
    ASSERT_NEAR(testing::sum_of(dual.beta()), 0.0, 1e-9);
  }
  ASSERT_TRUE(report.has_value());
  EXPECT_TRUE(report->converged);
  EXPECT_GT(slices, 10);
  EXPECT_LE(kkt_afresh(dual).gap(), 1e-9);
  DualProblem smo = testing::dual_of(problem);
  SmoSolver(1e-9, kBound).solve(smo);
  EXPECT_NEAR(objective(dual), objective(smo), 1e-7 * std::abs(objective(smo)) + 1e-9);
}

// Out of budget at every step, so that each solve is cut into as many calls as it has steps.
TEST(PathSolver, AnInterruptedPathIsTakenUpWhereItStopped) {
  const Problem problem = smooth_problem(7, 60);
  Buffer whole(problem, 60);
  Buffer pieces(problem, 60);
  int calls = 0;
  for (std::size_t i = 0; i < 60; ++i) {
    whole.add(i);
    pieces.collect(i);
    while (true) {
      Budget one(1);
      const SolveReport report = pieces.solver().solve(pieces.dual(), one);
      ASSERT_NEAR(testing::sum_of(pieces.dual().beta()), 0.0, 1e-10);
      ++calls;
      ASSERT_LT(calls, 10'000);
      if (!one.exhausted()) {
        ASSERT_TRUE(report.converged);
        break;
      }
      ASSERT_FALSE(report.converged);
    }
    ASSERT_NEAR(objective(pieces.dual()), objective(whole.dual()), 1e-9);
  }
  EXPECT_GT(calls, 120);
}

TEST(PathSolver, TakesOverFromAnyWeights) {
  const Problem problem = smooth_problem(8, 70);
  Buffer buffer(problem, 70);
  for (std::size_t i = 0; i < 70; ++i) {
    buffer.add(i);
  }
  for (std::size_t i = 0; i < 70; i += 7) {
    buffer.dual().hand_over(i);  // behind the solver's back
  }
  EXPECT_GT(buffer.dual().kkt().gap(), 1e-3);
  EXPECT_TRUE(buffer.solver().solve(buffer.dual()).converged);
  EXPECT_LE(kkt_afresh(buffer.dual()).gap(), 1e-9);
}

TEST(PathSolver, TrivialProblems) {
  PathSolver solver(2, 1e-9, 100);
  DualProblem dual(2, 0.1, 1.0);
  EXPECT_TRUE(solver.solve(dual).converged);
  dual.add({}, 1.0, 3.0);
  EXPECT_TRUE(solver.solve(dual).converged);
  EXPECT_EQ(dual.beta()[0], 0.0);
  EXPECT_DOUBLE_EQ(dual.kkt().bias(), 3.0);
  const double same_point = 1.0;
  dual.add({&same_point, 1}, 1.0, -3.0);  // contradicts the first: both end at the bound
  EXPECT_TRUE(solver.solve(dual).converged);
  EXPECT_EQ(dual.beta()[0], 1.0);
  EXPECT_EQ(dual.beta()[1], -1.0);
}

}  // namespace
}  // namespace kelpie::path_solver_test
