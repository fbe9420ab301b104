// SPDX-License-Identifier: Apache-2.0
#include "svr/mixed_kernel.hpp"

#include <algorithm>

#include "core/vector.hpp"

namespace kelpie {
namespace {

// x^32 by squaring.
double to_fine(double x) {
  for (int i = 0; i < 5; ++i) {
    x *= x;
  }
  return x;
}

}  // namespace

void MixedKernel::row(std::span<const double> x, const SampleStore& samples,
                      std::span<const double> similarity, std::span<double> out) const {
  const std::size_t n = samples.size();
  const std::span<double> row = out.first(n);
  const double s = weights_.s;
  const double fine = weights_.fine;
  if (fine > 0.0) {
    std::ranges::transform(similarity.first(n), row.begin(),
                           [=](double k) { return s * k + fine * to_fine(k); });
  } else {
    std::ranges::transform(similarity.first(n), row.begin(), [=](double k) { return s * k; });
  }
  const std::span<const double> terms = terms_of(x);
  const auto factor = [&](std::size_t k) { return weights_.lambda * terms[k]; };
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
  return weights_.s + weights_.fine + weights_.lambda * dot(terms, terms);
}

double MixedKernel::expansion(std::span<const double> x, const SampleStore& samples,
                              std::span<const double> beta) const {
  return weights_.s * local_.expansion(inputs_of(x), samples, beta);
}

double MixedKernel::fine_expansion(std::span<const double> x, const SampleStore& samples,
                                   std::span<const double> beta) const {
  return weights_.fine > 0.0 ? weights_.fine * fine_.expansion(inputs_of(x), samples, beta) : 0.0;
}

}  // namespace kelpie
