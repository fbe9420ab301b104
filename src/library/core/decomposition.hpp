// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>

// Decompositions of dense matrices, compiled once: every source that names a decomposition of Eigen
// compiles the decomposition anew, which takes the compiler several seconds. All functions allocate
// except those in place.
namespace kelpie {

/// L D Lᵀ of a symmetric matrix, with pivots, for many right-hand sides. Cost O(n³), O(n²) each.
class SymmetricFactor {
 public:
  explicit SymmetricFactor(const Eigen::MatrixXd& symmetric);
  Eigen::VectorXd solve(const Eigen::VectorXd& right) const;

 private:
  struct Factor;
  std::shared_ptr<const Factor> factor_;
};

/// P⁻¹ L U Q⁻¹ of any square matrix, with complete pivoting, likewise.
class PivotedFactor {
 public:
  explicit PivotedFactor(const Eigen::MatrixXd& square);
  Eigen::VectorXd solve(const Eigen::VectorXd& right) const;
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;  ///< As above.

 private:
  struct Factor;
  std::shared_ptr<const Factor> factor_;
};

/// A⁻¹ B of a symmetric A, by the same factor. Requires as many rows in A as in B.
Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);
Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);  ///< As above.

/// Cholesky's factor L of a positive definite matrix, in the place of the matrix.
void factorise_in_place(Eigen::Ref<Eigen::MatrixXd> definite);
/// (L Lᵀ)⁻¹ B in the place of B, by a factor of factorise_in_place().
void solve_in_place(const Eigen::Ref<const Eigen::MatrixXd>& factor, Eigen::Ref<Eigen::MatrixXd> b);

Eigen::MatrixXd inverse(const Eigen::MatrixXd& square);  ///< By partial pivoting.
double determinant(const Eigen::MatrixXd& square);       ///< By partial pivoting.

/// Eigenvalues, ascending, and eigenvectors of a symmetric matrix.
struct Eigenpairs {
  Eigen::Vector2d values;
  Eigen::Matrix2d vectors;
};
Eigenpairs eigenpairs(const Eigen::Matrix2d& symmetric);

/// Singular values, descending, and the left singular vectors.
struct SingularPairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd left;
};
SingularPairs singular_pairs(const Eigen::MatrixXd& matrix);

}  // namespace kelpie
