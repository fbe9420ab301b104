// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

namespace kelpie {

/// minimise ½ xᵀHx − gᵀx subject to x_i ≥ 0 for i in `signs` and [x_a x_b; x_b x_c] ⪰ `least` · I
/// for the places a, b, c of `block`, if any. Convex: H symmetric, positive definite.
struct ConeProgram {
  Eigen::MatrixXd hessian{};
  Eigen::VectorXd gradient{};  ///< g
  std::vector<Eigen::Index> signs{};
  std::optional<std::array<Eigen::Index, 3>> block{};
  double least = 0.0;
};

struct ConeSolution {
  Eigen::VectorXd x;
  std::vector<bool> at_bound;  ///< per variable: the sign constraint is active
  bool block_at_bound = false;
};

/// The unconstrained solution, if feasible; otherwise alternating directions (ADMM: Boyd et al.
/// 2011) to a relative tolerance of 1e-10, in at most 3,000 rounds.
ConeSolution solve(const ConeProgram& program);

}  // namespace kelpie
