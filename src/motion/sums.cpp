// SPDX-License-Identifier: Apache-2.0
#include "kelpie/motion/sums.hpp"

#include "core/eigen.hpp"
#include "motion/maps.hpp"

namespace kelpie {

Sums::Sums(std::size_t terms, std::size_t axes)
    : terms_(terms), axes_(axes), a_(terms * terms), b_(terms * axes), c_(axes * axes) {}

void Sums::add(std::span<const double> phi, std::span<const double> y) {
  ++rows_;
  const auto row = as_vector(phi);
  const auto target = as_vector(y);
  matrix_of(std::span(a_), terms_).noalias() += row * row.transpose();
  matrix_of(std::span(b_), terms_).noalias() += row * target.transpose();
  matrix_of(std::span(c_), axes_).noalias() += target * target.transpose();
}

void Sums::add(const Sums& other) {
  rows_ += other.rows_;
  as_vector(a_) += as_vector(other.a_);
  as_vector(b_) += as_vector(other.b_);
  as_vector(c_) += as_vector(other.c_);
}

void Sums::scale(double factor) {
  rows_ *= factor;
  as_vector(a_) *= factor;
  as_vector(b_) *= factor;
  as_vector(c_) *= factor;
}

// Σ φ(y + Δᵀφ)ᵀ = B + AΔ; the squares likewise.
void Sums::shift(std::span<const double> delta) {
  const auto by = matrix_of(delta, terms_);
  const auto a = matrix_of(std::span<const double>(a_), terms_);
  auto b = matrix_of(std::span(b_), terms_);
  auto c = matrix_of(std::span(c_), axes_);
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

void Sums::visit(Archive& archive) {
  archive.number(rows_);
  for (std::size_t k = 0; k < terms_; ++k) {
    archive.numbers(std::span(a_).subspan(k * (terms_ + 1), terms_ - k));
    for (std::size_t i = k; i < terms_; ++i) {
      a_[i * terms_ + k] = a_[k * terms_ + i];
    }
  }
  archive.numbers(b_);
  archive.numbers(c_);
}

}  // namespace kelpie
