// SPDX-License-Identifier: Apache-2.0
#include "identify/cone_program.hpp"

#include <algorithm>
#include <cmath>

#include "core/decomposition.hpp"

namespace kelpie {
namespace {

constexpr int kMostRounds = 3'000;
constexpr double kClose = 1e-10;

Eigen::Matrix2d block_of(const ConeProgram& program, const Eigen::VectorXd& x) {
  const auto [a, b, c] = *program.block;
  return (Eigen::Matrix2d() << x(a), x(b), x(b), x(c)).finished();
}

// The nearest vector that keeps the constraints, in the metric of alternating directions.
Eigen::VectorXd projected(const ConeProgram& program, Eigen::VectorXd x) {
  for (const Eigen::Index i : program.signs) {
    x(i) = std::max(x(i), 0.0);
  }
  if (!program.block) {
    return x;
  }
  const Eigenpairs eigen = eigenpairs(block_of(program, x));
  if (eigen.values.minCoeff() < program.least) {
    const Eigen::Matrix2d nearest = eigen.vectors *
                                    eigen.values.cwiseMax(program.least).asDiagonal() *
                                    eigen.vectors.transpose();
    const auto [a, b, c] = *program.block;
    x(a) = nearest(0, 0);
    x(b) = nearest(0, 1);
    x(c) = nearest(1, 1);
  }
  return x;
}

// Of each variable; that of the block is one for its matrix, whose other diagonal counts twice.
Eigen::VectorXd penalties(const ConeProgram& program) {
  Eigen::VectorXd rho = program.hessian.diagonal();
  if (program.block) {
    const auto [a, b, c] = *program.block;
    const double common = std::sqrt(rho(a) * rho(c));
    rho(a) = rho(c) = common;
    rho(b) = 2.0 * common;
  }
  return 0.1 * rho;
}

}  // namespace

ConeSolution solve(const ConeProgram& program) {
  ConeSolution solution;
  const Eigen::Index n = program.gradient.size();
  solution.at_bound.assign(static_cast<std::size_t>(n), false);
  const Eigen::VectorXd scale = program.hessian.diagonal().cwiseSqrt();
  solution.x = solve_symmetric(program.hessian, program.gradient);
  Eigen::VectorXd z = projected(program, solution.x);
  if ((z - solution.x).isZero(0.0)) {
    return solution;
  }
  const Eigen::VectorXd rho = penalties(program);
  Eigen::MatrixXd system = program.hessian;
  system.diagonal() += rho;
  const SymmetricFactor factor(system);
  Eigen::VectorXd dual = Eigen::VectorXd::Zero(n);  // scaled by rho
  const double size = scale.cwiseProduct(z).norm();
  for (int round = 0; round < kMostRounds; ++round) {
    const Eigen::VectorXd x = factor.solve(program.gradient + rho.cwiseProduct(z - dual));
    const Eigen::VectorXd next = projected(program, x + dual);
    dual += x - next;
    const double moved = scale.cwiseProduct(next - z).norm() + scale.cwiseProduct(x - next).norm();
    z = next;
    if (moved <= kClose * size) {
      break;
    }
  }
  solution.x = z;
  for (const Eigen::Index i : program.signs) {
    solution.at_bound[static_cast<std::size_t>(i)] = z(i) == 0.0;
  }
  solution.block_at_bound = program.block && eigenpairs(block_of(program, z)).values.minCoeff() <=
                                                 program.least * (1.0 + 1e-6);
  return solution;
}

}  // namespace kelpie
