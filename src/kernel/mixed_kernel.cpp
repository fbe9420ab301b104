// SPDX-License-Identifier: Apache-2.0
#include "kelpie/kernel/mixed_kernel.hpp"

#include <algorithm>

#include "kelpie/core/vector.hpp"

namespace kelpie {

void MixedKernel::row(std::span<const double> x, const SampleStore& samples,
                      std::span<const double> similarity, std::span<double> out) const {
  const std::size_t n = samples.size();
  const std::span<double> row = out.first(n);
  std::ranges::transform(similarity.first(n), row.begin(), [this](double k) { return s_ * k; });
  const std::span<const double> terms = terms_of(x);
  const auto factor = [&](std::size_t k) { return lambda_ * terms[k]; };
  const auto coordinate = [&](std::size_t k) { return samples.coordinate(inputs_ + k); };
  std::size_t k = 0;
  for (; k + 4 <= terms_; k += 4) {
    add_scaled({factor(k), factor(k + 1), factor(k + 2), factor(k + 3)},
               Four<double>{coordinate(k).data(), coordinate(k + 1).data(),
                            coordinate(k + 2).data(), coordinate(k + 3).data()},
               row);
  }
  for (; k < terms_; ++k) {
    add_scaled(factor(k), coordinate(k), row);
  }
}

double MixedKernel::self(std::span<const double> x) const {
  const std::span<const double> terms = terms_of(x);
  return s_ + lambda_ * dot(terms, terms);
}

}  // namespace kelpie
