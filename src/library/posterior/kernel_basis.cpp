// SPDX-License-Identifier: Apache-2.0
#include "posterior/kernel_basis.hpp"

#include <algorithm>
#include <cmath>

#include "core/vector.hpp"

namespace kelpie {

KernelBasis::KernelBasis(double gamma, std::size_t inputs, std::size_t capacity)
    : kernel_(gamma), centres_(inputs, capacity), factor_(capacity) {}

double KernelBasis::evaluate(std::span<const double> z, std::span<double> values) const {
  kernel_.row(z, centres_, values);
  factor_.solve_lower(values);
  return std::clamp(1.0 - dot(std::span<const double>(values), values), 0.0, 1.0);
}

void KernelBasis::add(std::span<const double> z, std::span<const double> values, double novelty) {
  centres_.push_back(z);
  factor_.resize(centres_.size());
  const std::span<double> row = factor_.row(centres_.size() - 1);
  std::ranges::copy(values, row.begin());
  row.back() = std::sqrt(novelty);
}

Matrix KernelBasis::move(std::span<const double> ratio, std::span<const double> shift,
                         double least_novelty) {
  KernelBasis moved(kernel_.gamma(), centres_.dimension(), centres_.capacity());
  std::vector<std::vector<double>> at(size(), std::vector<double>(centres_.dimension()));
  std::vector<double> values(centres_.capacity());
  for (std::size_t i = 0; i < size(); ++i) {
    centres_.get(i, at[i]);
    for (std::size_t k = 0; k < at[i].size(); ++k) {
      at[i][k] = at[i][k] * ratio[k] + shift[k];
    }
    const std::span<double> known = std::span(values).first(moved.size());
    if (const double novelty = moved.evaluate(at[i], known); novelty > least_novelty) {
      moved.add(at[i], known, novelty);
    }
  }
  // Column by column, T = L⁻¹ V, V_ij = v_j(c_i).
  Matrix t(size(), moved.size());
  for (std::size_t i = 0; i < size(); ++i) {
    const std::span<double> known = std::span(values).first(moved.size());
    moved.evaluate(at[i], known);
    for (std::size_t j = 0; j < known.size(); ++j) {
      t(i, j) = known[j];
    }
  }
  for (std::size_t j = 0; j < moved.size(); ++j) {
    factor_.solve_lower(t.values().subspan(j * size(), size()));
  }
  *this = std::move(moved);
  return t;
}

void KernelBasis::visit(Archive& archive) {
  archive.part("centres", centres_);
  archive.part("factor", factor_);
  archive.require(factor_.size() == centres_.size(), "as many rows as centres are due");
}

}  // namespace kelpie
