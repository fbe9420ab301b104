// SPDX-License-Identifier: Apache-2.0
#include "posterior/triangle.hpp"

#include <algorithm>
#include <cmath>

#include "core/vector.hpp"

namespace kelpie {

void Triangle::scale(double factor) {
  for (double& value : values_) {
    value *= factor;
  }
}

void Triangle::add_square(double weight, std::span<const double> x) {
  for (std::size_t i = 0; i < size_; ++i) {
    if (x[i] != 0.0) {
      add_scaled(weight * x[i], x.first(i + 1), row(i));
    }
  }
}

void Triangle::multiply(std::span<const double> x, std::span<double> y) const {
  std::ranges::fill(y.first(x.size()), 0.0);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const std::span<const double> before = row(i).first(i);
    y[i] += dot(row(i), x.first(i + 1));
    add_scaled(x[i], before, y.first(i));
  }
}

bool Triangle::factorise_row(std::size_t i) {
  const std::span<double> here = row(i);
  for (std::size_t j = 0; j < i; ++j) {
    const std::span<const double> above = row(j);
    here[j] = (here[j] - dot(above.first(j), here.first(j))) / above[j];
  }
  const double left = here[i] - dot(here.first(i), here.first(i));
  here[i] = std::sqrt(left);
  return left > 0.0;
}

void Triangle::solve_lower(std::span<double> x) const {
  for (std::size_t i = 0; i < x.size(); ++i) {
    const std::span<const double> here = row(i);
    x[i] = (x[i] - dot(here.first(i), x.first(i))) / here[i];
  }
}

void Triangle::solve_upper(std::span<double> x) const {
  for (std::size_t i = x.size(); i-- > 0;) {
    const std::span<const double> here = row(i);
    x[i] /= here[i];
    add_scaled(-x[i], here.first(i), x.first(i));
  }
}

void Triangle::visit(Archive& archive) {
  archive.length(size_, values_.capacity());
  if (archive.loading()) {
    resize(size_);
  }
  archive.numbers(values_);
}

}  // namespace kelpie
