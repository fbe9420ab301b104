// SPDX-License-Identifier: Apache-2.0
#include "core/normal_equations.hpp"

#include <algorithm>
#include <limits>

#include "core/decomposition.hpp"

namespace kelpie {

NormalEquations::NormalEquations(std::size_t terms, std::size_t targets)
    : terms_(terms),
      targets_(targets),
      a_(terms * terms),
      b_(terms * targets),
      c_(targets * targets) {}

NormalEquations NormalEquations::of_weighted(const Eigen::MatrixXd& design,
                                             const Eigen::MatrixXd& targets,
                                             const Eigen::VectorXd& weights) {
  NormalEquations sums(static_cast<std::size_t>(design.cols()),
                       static_cast<std::size_t>(targets.cols()));
  const Eigen::MatrixXd weighted = weights.asDiagonal() * design;
  columns_of(std::span(sums.a_), sums.terms_) = design.transpose() * weighted;
  columns_of(std::span(sums.b_), sums.terms_) = weighted.transpose() * targets;
  columns_of(std::span(sums.c_), sums.targets_) =
      targets.transpose() * weights.asDiagonal() * targets;
  sums.rows_ = weights.sum();
  return sums;
}

void NormalEquations::add(std::span<const double> phi, std::span<const double> y) {
  ++rows_;
  const auto row = as_vector(phi);
  const auto target = as_vector(y);
  columns_of(std::span(a_), terms_).noalias() += row * row.transpose();
  columns_of(std::span(b_), terms_).noalias() += row * target.transpose();
  columns_of(std::span(c_), targets_).noalias() += target * target.transpose();
}

void NormalEquations::add_block(const Eigen::Ref<const Eigen::MatrixXd>& phi,
                                const Eigen::Ref<const Eigen::MatrixXd>& y) {
  rows_ += static_cast<double>(phi.cols());
  columns_of(std::span(a_), terms_).noalias() += phi * phi.transpose();
  columns_of(std::span(b_), terms_).noalias() += phi * y.transpose();
  auto squares = columns_of(std::span(c_), targets_);
  const Eigen::VectorXd own = y.rowwise().squaredNorm();
  squares.diagonal() += own;
  for (Eigen::Index i = 0; i < y.rows(); ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      squares(i, j) += y.row(i).dot(y.row(j));
      squares(j, i) = squares(i, j);
    }
  }
}

void NormalEquations::add(const NormalEquations& other) {
  rows_ += other.rows_;
  as_vector(a_) += as_vector(other.a_);
  as_vector(b_) += as_vector(other.b_);
  as_vector(c_) += as_vector(other.c_);
}

void NormalEquations::subtract(const NormalEquations& other) {
  rows_ -= other.rows_;
  as_vector(a_) -= as_vector(other.a_);
  as_vector(b_) -= as_vector(other.b_);
  as_vector(c_) -= as_vector(other.c_);
}

void NormalEquations::clear() {
  rows_ = 0.0;
  for (std::vector<double>* const sums : {&a_, &b_, &c_}) {
    std::ranges::fill(*sums, 0.0);
  }
}

void NormalEquations::scale(double factor) {
  rows_ *= factor;
  as_vector(a_) *= factor;
  as_vector(b_) *= factor;
  as_vector(c_) *= factor;
}

// Σ φ(y + Δᵀφ)ᵀ = B + AΔ;  Σ (y + Δᵀφ)(y + Δᵀφ)ᵀ = C + ΔᵀB + BᵀΔ + ΔᵀAΔ.
void NormalEquations::shift(std::span<const double> delta) {
  const auto by = columns_of(delta, terms_);
  const auto a = gram();
  auto b = columns_of(std::span(b_), terms_);
  auto c = columns_of(std::span(c_), targets_);
  for (Eigen::Index i = 0; i < c.rows(); ++i) {
    for (Eigen::Index j = 0; j < c.cols(); ++j) {
      c(i, j) += by.col(i).dot(b.col(j)) + b.col(i).dot(by.col(j));
      for (Eigen::Index k = 0; k < a.cols(); ++k) {
        c(i, j) += by(k, j) * a.col(k).dot(by.col(i));
      }
    }
  }
  for (Eigen::Index j = 0; j < b.cols(); ++j) {
    for (Eigen::Index k = 0; k < a.cols(); ++k) {
      b.col(j) += by(k, j) * a.col(k);
    }
  }
}

void NormalEquations::solve(double ridge, std::span<double> scratch,
                            std::span<double> theta) const {
  auto inside = columns_of(scratch.first(a_.size()), terms_);
  inside = gram();
  add_relative_ridge(inside, ridge);
  factorise_in_place(inside);
  auto solution = columns_of(theta, terms_);
  solution = moments();
  solve_in_place(inside, solution);
}

Eigen::MatrixXd NormalEquations::solve(const Eigen::VectorXd& prior) const {
  Eigen::MatrixXd system = gram();
  system.diagonal() += prior;
  return solve_symmetric(system, Eigen::MatrixXd(moments()));
}

Eigen::ArrayXd NormalEquations::squared_errors(const Eigen::MatrixXd& theta) const {
  return (squares().diagonal() -
          2.0 * (theta.array() * moments().array()).colwise().sum().matrix().transpose() +
          (theta.array() * (gram() * theta).array()).colwise().sum().matrix().transpose())
      .array();
}

void NormalEquations::visit(Archive& archive) {
  archive.number(rows_);
  for (std::size_t k = 0; k < terms_; ++k) {
    archive.numbers(std::span(a_).subspan(k * (terms_ + 1), terms_ - k));
    for (std::size_t i = k; archive.loading() && i < terms_; ++i) {
      a_[i * terms_ + k] = a_[k * terms_ + i];
    }
  }
  archive.numbers(b_);
  archive.numbers(c_);
}

Eigen::MatrixXd equilibrated_inverse(const Eigen::MatrixXd& gram) {
  constexpr double kRidge = 1e-12;  // against the diagonal, which is 1
  const Eigen::VectorXd size =
      gram.diagonal().cwiseMax(std::numeric_limits<double>::min()).cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd scaled = size.asDiagonal() * gram * size.asDiagonal();
  scaled.diagonal().array() += kRidge;
  for (Eigen::Index i = 0; i < gram.rows(); ++i) {
    if (gram(i, i) <= 0.0) {
      scaled(i, i) = 1.0;
    }
  }
  const Eigen::MatrixXd inverse =
      solve_symmetric(scaled, Eigen::MatrixXd(Eigen::MatrixXd::Identity(gram.rows(), gram.rows())));
  return size.asDiagonal() * inverse * size.asDiagonal();
}

}  // namespace kelpie
