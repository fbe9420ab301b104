// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include "kelpie/core/random.hpp"
#include "svr/dual_problem.hpp"

namespace kelpie::testing {

/// A regression problem to be solved by whoever.
struct Problem {
  std::vector<std::vector<double>> x;
  std::vector<double> y;
  double gamma = 1.0;
  double c = 1.0;
  double epsilon = 0.1;
};

inline double kernel(const Problem& problem, std::size_t i, std::size_t j) {
  double square = 0.0;
  for (std::size_t k = 0; k < problem.x[i].size(); ++k) {
    const double difference = problem.x[i][k] - problem.x[j][k];
    square += difference * difference;
  }
  return std::exp(-problem.gamma * square);
}

inline void add_sample(DualProblem& dual, const Problem& problem, std::size_t i,
                       const std::vector<std::size_t>& members) {
  std::vector<double> row;
  row.reserve(members.size());
  for (const std::size_t j : members) {
    row.push_back(kernel(problem, i, j));
  }
  dual.add(row, kernel(problem, i, i), problem.y[i]);
}

inline DualProblem dual_of(const Problem& problem) {
  DualProblem dual(problem.x.size(), problem.epsilon, problem.c);
  std::vector<std::size_t> members;
  for (std::size_t i = 0; i < problem.x.size(); ++i) {
    add_sample(dual, problem, i, members);
    members.push_back(i);
  }
  return dual;
}

/// A random problem with what makes solvers stumble: duplicated points (with equal or contradicting
/// targets), constant targets, ε = 0, kernels from nearly constant to nearly diagonal.
inline Problem random_problem(RandomStream& random, std::size_t n) {
  Problem problem;
  const std::size_t d = 1 + random.below(6);
  problem.gamma = std::pow(10.0, random.uniform(-2.0, 1.0));
  problem.c = std::pow(10.0, random.uniform(-1.0, 2.0));
  problem.epsilon = random.below(4) == 0 ? 0.0 : std::pow(10.0, random.uniform(-3.0, -0.3));
  const bool constant = random.below(12) == 0;
  const bool duplicates = random.below(3) == 0;
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<double> x(d);
    double y = 0.0;
    for (double& value : x) {
      value = random.normal();
      y += std::sin(2.0 * value);
    }
    if (duplicates && i > 0 && random.below(4) == 0) {
      x = problem.x[random.below(i)];
    }
    problem.x.push_back(x);
    problem.y.push_back(constant ? 0.7 : y + 0.1 * random.normal());
  }
  return problem;
}

inline double sum_of(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) {
    sum += value;
  }
  return sum;
}

}  // namespace kelpie::testing
