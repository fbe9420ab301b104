// SPDX-License-Identifier: Apache-2.0
#include "vehicle/comparison.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/decomposition.hpp"
#include "vehicle/tuning.hpp"

namespace kelpie {
namespace {

// Where rows say nothing the least of their usual size keeps a factorisation from breaking down.
constexpr double kRidge = 1e-9;

constexpr auto kMost = static_cast<Eigen::Index>(kMostColumns);
using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMost, kMost>;
using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMost, 1>;

std::span<const double> read(const std::vector<double>& numbers) {
  return numbers;
}

}  // namespace

ReferenceFit::ReferenceFit(std::size_t terms, std::size_t axes)
    : theta_(terms * axes), precision_(axes * axes), scratch_(terms * terms) {}

void ReferenceFit::fit(const NormalEquations& sums) {
  sums.solve(kRidge, scratch_, theta_);
  const auto theta = columns_of(read(theta_), sums.terms());
  const auto b = sums.moments();
  auto precision = columns_of(std::span(precision_), sums.targets());
  auto left = columns_of(std::span(scratch_).first(precision_.size()), sums.targets());
  const auto c = sums.squares();
  for (Eigen::Index i = 0; i < c.rows(); ++i) {
    for (Eigen::Index j = 0; j < c.cols(); ++j) {
      left(i, j) = (c(i, j) - theta.col(i).dot(b.col(j))) / sums.rows();
    }
    left(i, i) = std::max(left(i, i), 1e-9 * c(i, i) / sums.rows() + 1e-300);
  }
  factorise_in_place(left);
  precision.setIdentity();
  solve_in_place(left, precision);
}

void ReferenceFit::visit(Archive& archive) {
  archive.numbers(theta_);
  archive.numbers(precision_);
}

Comparison::Comparison(std::size_t terms, std::size_t axes, std::size_t columns)
    : terms_(terms),
      joint_(terms * terms),
      narrow_(terms * terms),
      score_(terms * axes),
      discounted_(terms * axes),
      information_(terms * terms),
      along_(terms * axes),
      precision_(axes * axes),
      gram_(columns * columns),
      slope_(columns) {}

void Comparison::compare(const NormalEquations& reference, const ReferenceFit& fit,
                         const NormalEquations& stretch, std::span<const double> directions) {
  const std::size_t terms = reference.terms();
  const auto before = reference.gram();
  const auto after = stretch.gram();
  const auto theta = columns_of(fit.theta(), terms);
  auto joint = columns_of(std::span(joint_), terms);
  auto narrow = columns_of(std::span(narrow_), terms);
  auto score = columns_of(std::span(score_), terms);
  auto discounted = columns_of(std::span(discounted_), terms);
  auto information = columns_of(std::span(information_), terms);
  auto along = columns_of(std::span(along_), terms);

  joint = before + after;
  add_relative_ridge(joint, kRidge);
  factorise_in_place(joint);

  score = stretch.moments();
  for (Eigen::Index j = 0; j < score.cols(); ++j) {
    for (Eigen::Index k = 0; k < after.cols(); ++k) {
      score.col(j) -= theta(k, j) * after.col(k);
    }
  }
  // G = g − A_a (A_a + A_b)⁻¹ g, P = A_a − A_a (A_a + A_b)⁻¹ A_a
  discounted = score;
  solve_in_place(joint, discounted);
  along = discounted;
  discounted = score;
  discounted.noalias() -= after * along;
  narrow = after;
  solve_in_place(joint, narrow);
  information = after;
  information.noalias() -= after * narrow;

  whole_ = refit_evidence(reference, stretch, fit.precision());
  precision_.assign(fit.precision().begin(), fit.precision().end());
  project(directions);
}

// Evidence of an unrestricted refit, with a ridge where the stretch was excited little.
double Comparison::refit_evidence(const NormalEquations& reference, const NormalEquations& stretch,
                                  std::span<const double> precision_numbers) {
  const auto precision = columns_of(precision_numbers, reference.targets());
  const auto score = columns_of(read(score_), terms_);
  const auto discounted = columns_of(read(discounted_), terms_);
  auto narrow = columns_of(std::span(narrow_), terms_);
  auto along = columns_of(std::span(along_), terms_);
  narrow = stretch.gram();
  narrow += kDiagnosis.excited_share * (stretch.rows() / std::max(reference.rows(), 1.0)) *
            reference.gram();
  add_relative_ridge(narrow, kRidge);
  factorise_in_place(narrow);
  along = score;
  solve_in_place(narrow, along);
  double whole = 0.0;
  for (Eigen::Index i = 0; i < score.cols(); ++i) {
    for (Eigen::Index j = 0; j < score.cols(); ++j) {
      whole += 0.5 * precision(i, j) * along.col(i).dot(discounted.col(j));
    }
  }
  return whole;
}

// The quadratic function of the sizes along all directions.
void Comparison::project(std::span<const double> directions) {
  const std::size_t columns = slope_.size();
  for (std::size_t c = 0; c < columns; ++c) {
    const auto direction = [&](std::size_t d) {
      return directions.subspan(d * along_.size(), along_.size());
    };
    slope_[c] = slope_along(direction(c));
    weigh(direction(c));
    for (std::size_t d = 0; d < columns; ++d) {
      gram_[c * columns + d] = as_vector(direction(d)).dot(as_vector(along_));
    }
  }
}

// tr(Σ⁻¹ Gᵀ D)
double Comparison::slope_along(std::span<const double> direction) const {
  const auto d = columns_of(direction, terms_);
  const auto g = columns_of(read(discounted_), terms_);
  const auto axes = static_cast<std::size_t>(d.cols());
  const auto precision = columns_of(read(precision_), axes);
  double sum = 0.0;
  for (Eigen::Index i = 0; i < d.cols(); ++i) {
    for (Eigen::Index j = 0; j < d.cols(); ++j) {
      sum += precision(i, j) * g.col(i).dot(d.col(j));
    }
  }
  return sum;
}

// along = P D Σ⁻¹
void Comparison::weigh(std::span<const double> direction) {
  const auto d = columns_of(direction, terms_);
  const auto precision = columns_of(read(precision_), static_cast<std::size_t>(d.cols()));
  auto moved = columns_of(std::span(score_), terms_);  // the score is done with
  moved.noalias() = columns_of(read(information_), terms_) * d;
  columns_of(std::span(along_), terms_) = moved.lazyProduct(precision);
}

Agreement Comparison::beyond(std::span<const double> delta, std::span<const double> tangent) {
  weigh(delta);
  const double curve = as_vector(along_).dot(as_vector(tangent));
  const double square = as_vector(along_).dot(as_vector(delta));
  weigh(tangent);
  const double information =
      std::max(as_vector(along_).dot(as_vector(tangent)), std::numeric_limits<double>::min());
  Agreement agreement;
  agreement.evidence = slope_along(delta) - 0.5 * square;
  agreement.size[0] = (slope_along(tangent) - curve) / information;
  agreement.error[0] = 1.0 / std::sqrt(information);
  return agreement;
}

Agreement Comparison::of(std::span<const std::size_t> columns,
                         std::span<const std::size_t> more) const {
  const auto size = static_cast<Eigen::Index>(columns.size() + more.size());
  const auto chosen = [&](Eigen::Index i) {
    const auto place = static_cast<std::size_t>(i);
    return place < columns.size() ? columns[place] : more[place - columns.size()];
  };
  Small normal(size, size);
  SmallVector slope(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    slope(i) = slope_[chosen(i)];
    for (Eigen::Index j = 0; j < size; ++j) {
      normal(i, j) = gram_[chosen(i) * slope_.size() + chosen(j)];
    }
  }
  add_relative_ridge(normal, kRidge);
  const Eigen::LLT<Small> factor(normal);
  const SmallVector best = factor.solve(slope);
  const Small spread = factor.solve(Small::Identity(size, size));
  Agreement agreement;
  agreement.evidence = 0.5 * slope.dot(best);
  for (Eigen::Index i = 0; i < size; ++i) {
    agreement.size[static_cast<std::size_t>(i)] = best(i);
    agreement.error[static_cast<std::size_t>(i)] = std::sqrt(std::max(spread(i, i), 0.0));
  }
  return agreement;
}

}  // namespace kelpie
