// SPDX-License-Identifier: Apache-2.0
#include "learner/triangular_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/eigen.hpp"
#include "core/vector.hpp"

namespace kelpie {
namespace {

using Factor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// [R z …] as a matrix of as many rows as there are terms.
template <typename Numbers>
auto as_factor(Numbers& numbers, std::size_t terms) {
  using Of = std::conditional_t<std::is_const_v<Numbers>, const Factor, Factor>;
  const auto m = static_cast<Eigen::Index>(terms);
  return Eigen::Map<Of>(numbers.data(), m, static_cast<Eigen::Index>(numbers.size()) / m);
}

// θ as a matrix: one column per target.
template <typename Numbers>
auto as_columns(Numbers& numbers, std::size_t terms) {
  constexpr bool kConst = std::is_const_v<std::remove_pointer_t<decltype(numbers.data())>>;
  using Of = std::conditional_t<kConst, const Eigen::MatrixXd, Eigen::MatrixXd>;
  const auto m = static_cast<Eigen::Index>(terms);
  return Eigen::Map<Of>(numbers.data(), m, static_cast<Eigen::Index>(numbers.size()) / m);
}

}  // namespace

TriangularFit::TriangularFit(std::size_t terms, double prior, std::size_t targets)
    : least_(prior),
      factor_(terms * (terms + targets)),
      row_(terms + targets),
      theta_(terms * targets),
      moment_(terms),
      prior_(terms),
      scratch_(terms) {}

void TriangularFit::add(std::span<const double> phi, std::span<const double> y) {
  ++rows_;
  add_priors(phi);
  std::ranges::copy(y, std::ranges::copy(phi, row_.begin()).out);
  absorb();
  solve();
}

// P → D⁻¹PD⁻¹ with D = diag(keep).
void TriangularFit::forget(std::span<const double> keep) {
  auto factor = as_factor(factor_, terms());
  const auto theta = as_columns(theta_, terms());
  const Eigen::Index m = theta.rows();
  for (Eigen::Index k = 0; k < m; ++k) {
    auto kept = factor.row(k).segment(k, m - k);
    kept.array() *= as_vector(keep).tail(m - k).transpose().array();
    for (Eigen::Index j = 0; j < theta.cols(); ++j) {
      factor(k, m + j) = kept.dot(theta.col(j).tail(m - k));
    }
  }
}

void TriangularFit::limit_rows(std::int64_t rows) {
  if (rows_ > rows) {
    as_vector(factor_) *= std::sqrt(static_cast<double>(rows) / static_cast<double>(rows_));
    rows_ = rows;
  }
}

void TriangularFit::hold(std::size_t term, double rows) {
  std::ranges::fill(row_, 0.0);
  row_[term] = std::sqrt(rows * moment_[term]);
  absorb();
  solve();
}

void TriangularFit::set_theta(std::span<const double> theta) {
  const auto m = static_cast<Eigen::Index>(terms());
  auto factor = as_factor(factor_, terms());
  const auto columns = as_columns(theta, terms());
  for (Eigen::Index j = 0; j < columns.cols(); ++j) {
    for (Eigen::Index k = 0; k < m; ++k) {
      factor(k, m + j) = factor.row(k).segment(k, m - k).dot(columns.col(j).tail(m - k));
    }
  }
  solve();
}

// P_kk = |R⁻ᵀ e_k|².
double TriangularFit::variance(std::size_t term) const {
  if (!(factor_[term * row_.size() + term] > 0.0)) {
    return std::numeric_limits<double>::infinity();
  }
  std::ranges::fill(scratch_, 0.0);
  scratch_[term] = 1.0;
  return forward_square(term, 0.0);
}

// φᵀPφ = |R⁻ᵀφ|².
double TriangularFit::leverage(std::span<const double> phi) const {
  std::ranges::copy(phi, scratch_.begin());
  return forward_square(0, std::numeric_limits<double>::infinity());
}

// Row after row of R, as R lies in memory: a column of R is a value per row, far apart.
double TriangularFit::forward_square(std::size_t first, double unexcited) const {
  const auto factor = as_factor(factor_, terms());
  auto scratch = as_vector(scratch_);
  double square = 0.0;
  for (auto k = static_cast<Eigen::Index>(first); k < scratch.size(); ++k) {
    if (!(factor(k, k) > 0.0)) {
      square += scratch(k) != 0.0 ? unexcited : 0.0;
      continue;
    }
    const double part = scratch(k) / factor(k, k);
    square += part * part;
    const Eigen::Index rest = scratch.size() - 1 - k;
    scratch.tail(rest) -= part * factor.row(k).segment(k + 1, rest).transpose();
  }
  return square;
}

void TriangularFit::clear() {
  for (std::vector<double>* const values : {&factor_, &theta_, &moment_, &prior_}) {
    std::ranges::fill(*values, 0.0);
  }
  rows_ = 0;
}

void TriangularFit::rescale(std::span<const double> factors) {
  auto factor = as_factor(factor_, terms());
  const Eigen::Index m = factor.rows();
  const auto by = as_vector(factors);
  for (Eigen::Index k = 0; k < m; ++k) {
    factor.row(k).head(m).array() *= by.transpose().array();
  }
  for (std::size_t k = 0; k < terms(); ++k) {
    moment_[k] *= factors[k] * factors[k];
    prior_[k] *= factors[k] * factors[k];
  }
  solve();
}

// Most terms of a young fit are centres to come: a row of zeros takes a flag's place.
void TriangularFit::visit(Archive& archive) {
  const std::size_t columns = row_.size();
  for (std::size_t k = 0; k < terms(); ++k) {
    const std::span<double> row = std::span(factor_).subspan(k * columns + k, columns - k);
    bool moved = std::ranges::any_of(row, [](double value) { return value != 0.0; });
    archive.flag(moved);
    if (moved) {
      archive.numbers(row);
    } else {
      std::ranges::fill(row, 0.0);
    }
  }
  for (std::vector<double>* const values : {&theta_, &moment_, &prior_}) {
    archive.numbers(*values);
  }
  archive.whole(rows_);
}

void TriangularFit::add_priors(std::span<const double> phi) {
  for (std::size_t k = 0; k < terms(); ++k) {
    moment_[k] += (phi[k] * phi[k] - moment_[k]) / static_cast<double>(rows_);
    const double wanted = least_ * moment_[k];
    if (wanted > 0.0 && wanted >= 2.0 * prior_[k]) {
      std::ranges::fill(row_, 0.0);
      row_[k] = std::sqrt(wanted - prior_[k]);
      prior_[k] = wanted;
      absorb();
    }
  }
}

// Rotates row_ into the factor.
void TriangularFit::absorb() {
  const std::size_t m = terms();
  for (std::size_t k = 0; k < m; ++k) {
    if (row_[k] == 0.0) {
      continue;
    }
    const std::size_t width = row_.size();
    const std::span<double> row = std::span(factor_).subspan(k * width + k, width - k);
    const double length = std::hypot(row[0], row_[k]);
    rotate(row[0] / length, row_[k] / length, row.subspan(1), std::span(row_).subspan(k + 1));
    row[0] = length;
    row_[k] = 0.0;
  }
}

void TriangularFit::solve() {
  const auto factor = as_factor(factor_, terms());
  auto theta = as_columns(theta_, terms());
  const Eigen::Index m = theta.rows();
  for (Eigen::Index j = 0; j < theta.cols(); ++j) {
    for (Eigen::Index k = m - 1; k >= 0; --k) {
      const Eigen::Index rest = m - 1 - k;
      const double known = factor.row(k).segment(k + 1, rest).dot(theta.col(j).tail(rest));
      theta(k, j) = factor(k, k) > 0.0 ? (factor(k, m + j) - known) / factor(k, k) : 0.0;
    }
  }
}

}  // namespace kelpie
