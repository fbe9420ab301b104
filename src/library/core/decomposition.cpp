// SPDX-License-Identifier: Apache-2.0
#include "core/decomposition.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>

namespace kelpie {

struct SymmetricFactor::Factor {
  Eigen::LDLT<Eigen::MatrixXd> ldlt;
};

SymmetricFactor::SymmetricFactor(const Eigen::MatrixXd& symmetric)
    : factor_(std::make_shared<const Factor>(Factor{symmetric.ldlt()})) {}

Eigen::VectorXd SymmetricFactor::solve(const Eigen::VectorXd& right) const {
  return factor_->ldlt.solve(right);
}

struct PivotedFactor::Factor {
  Eigen::FullPivLU<Eigen::MatrixXd> lu;
};

PivotedFactor::PivotedFactor(const Eigen::MatrixXd& square)
    : factor_(std::make_shared<const Factor>(Factor{square.fullPivLu()})) {}

Eigen::VectorXd PivotedFactor::solve(const Eigen::VectorXd& right) const {
  return factor_->lu.solve(right);
}

Eigen::MatrixXd PivotedFactor::solve(const Eigen::MatrixXd& right) const {
  return factor_->lu.solve(right);
}

Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  return a.ldlt().solve(b);
}

Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.ldlt().solve(b);
}

void factorise_in_place(Eigen::Ref<Eigen::MatrixXd> definite) {
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(definite);
}

void solve_in_place(const Eigen::Ref<const Eigen::MatrixXd>& factor,
                    Eigen::Ref<Eigen::MatrixXd> b) {
  factor.triangularView<Eigen::Lower>().solveInPlace(b);
  factor.triangularView<Eigen::Lower>().adjoint().solveInPlace(b);
}

Eigen::MatrixXd inverse(const Eigen::MatrixXd& square) {
  return square.inverse();
}

double determinant(const Eigen::MatrixXd& square) {
  return square.determinant();
}

Eigenpairs eigenpairs(const Eigen::Matrix2d& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(symmetric);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

SingularPairs singular_pairs(const Eigen::MatrixXd& matrix) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(matrix, Eigen::ComputeThinU);
  return {svd.singularValues(), svd.matrixU()};
}

}  // namespace kelpie
