// SPDX-License-Identifier: Apache-2.0
#include "kelpie/online/triangular_fit.hpp"

#include <cmath>
#include <limits>

#include "kelpie/core/vector.hpp"

namespace kelpie {

TriangularFit::TriangularFit(Eigen::Index terms, double prior)
    : least_(prior),
      factor_(Factor::Zero(terms, terms + 1)),
      row_(Eigen::RowVectorXd::Zero(terms + 1)),
      theta_(Eigen::VectorXd::Zero(terms)),
      moment_(Eigen::VectorXd::Zero(terms)),
      prior_(Eigen::VectorXd::Zero(terms)),
      scratch_(Eigen::VectorXd::Zero(terms)) {}

void TriangularFit::add(const Eigen::Ref<const Eigen::VectorXd>& phi, double y) {
  ++rows_;
  add_priors(phi);
  row_ << phi.transpose(), y;
  absorb();
  solve();
}

// P → D⁻¹PD⁻¹ with D = diag(keep).
void TriangularFit::forget(const Eigen::VectorXd& keep) {
  const Eigen::Index m = terms();
  for (Eigen::Index k = 0; k < m; ++k) {
    auto kept = factor_.row(k).segment(k, m - k);
    kept.array() *= keep.tail(m - k).transpose().array();
    factor_(k, m) = kept.dot(theta_.tail(m - k));
  }
}

void TriangularFit::settle(const Eigen::VectorXd& theta) {
  const Eigen::Index m = terms();
  factor_.col(m) = factor_.leftCols(m).triangularView<Eigen::Upper>() * theta;
  solve();
}

// P_kk = |R⁻ᵀ e_k|², by forward substitution.
double TriangularFit::variance(Eigen::Index k) const {
  if (!(factor_(k, k) > 0.0)) {
    return std::numeric_limits<double>::infinity();
  }
  scratch_(k) = 1.0 / factor_(k, k);
  double square = scratch_(k) * scratch_(k);
  for (Eigen::Index j = k + 1; j < terms(); ++j) {
    const Eigen::Index between = j - k;
    const double sum = factor_.col(j).segment(k, between).dot(scratch_.segment(k, between));
    scratch_(j) = factor_(j, j) > 0.0 ? -sum / factor_(j, j) : 0.0;
    square += scratch_(j) * scratch_(j);
  }
  return square;
}

void TriangularFit::clear() {
  factor_.setZero();
  theta_.setZero();
  moment_.setZero();
  prior_.setZero();
  rows_ = 0;
}

void TriangularFit::visit(Archive& archive) {
  archive.numbers({factor_.data(), static_cast<std::size_t>(factor_.size())});
  for (Eigen::VectorXd* values : {&theta_, &moment_, &prior_}) {
    archive.numbers({values->data(), static_cast<std::size_t>(values->size())});
  }
  archive.whole(rows_);
}

void TriangularFit::add_priors(const Eigen::Ref<const Eigen::VectorXd>& phi) {
  moment_ += (phi.cwiseAbs2() - moment_) / static_cast<double>(rows_);
  for (Eigen::Index k = 0; k < terms(); ++k) {
    const double wanted = least_ * moment_(k);
    if (wanted > 0.0 && wanted >= 2.0 * prior_(k)) {
      row_.setZero();
      row_(k) = std::sqrt(wanted - prior_(k));
      prior_(k) = wanted;
      absorb();
    }
  }
}

// Rotates row_ into the factor.
void TriangularFit::absorb() {
  const Eigen::Index m = terms();
  for (Eigen::Index k = 0; k < m; ++k) {
    if (row_(k) == 0.0) {
      continue;
    }
    const double length = std::hypot(factor_(k, k), row_(k));
    const auto rest = static_cast<std::size_t>(m - k);
    rotate(factor_(k, k) / length, row_(k) / length, {&factor_(k, k + 1), rest},
           {&row_(k + 1), rest});
    factor_(k, k) = length;
    row_(k) = 0.0;
  }
}

void TriangularFit::solve() {
  const Eigen::Index m = terms();
  for (Eigen::Index k = m - 1; k >= 0; --k) {
    const Eigen::Index rest = m - 1 - k;
    const double known = factor_.row(k).segment(k + 1, rest).dot(theta_.tail(rest));
    theta_(k) = factor_(k, k) > 0.0 ? (factor_(k, m) - known) / factor_(k, k) : 0.0;
  }
}

}  // namespace kelpie
