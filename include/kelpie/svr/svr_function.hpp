// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kelpie/kernel/sample_store.hpp"
#include "kelpie/kernel/squared_exponential.hpp"

namespace kelpie {

/// A trained regression function f(x) = Σ β_i κ(x_i, x) + b (eq. 5, with the bias), on scaled
/// inputs and in units of the standardised target. Holds its own copy of the support vectors.
/// Allocates in the constructor only.
class SvrFunction {
 public:
  SvrFunction(const SquaredExponential& kernel, std::size_t dimension, std::size_t capacity);

  /// Takes over the samples with a weight. Cost O(n d).
  void assign(const SampleStore& samples, std::span<const double> beta, double bias);

  /// Requires z of the kernel's dimension. Cost O(n d). Allocates nothing; safe from many threads.
  double operator()(std::span<const double> z) const;

  const SquaredExponential& kernel() const { return kernel_; }
  const SampleStore& support_vectors() const { return samples_; }
  std::span<const double> beta() const { return {beta_.data(), samples_.size()}; }
  double bias() const { return bias_; }

  /// Memory of a function in bytes, beside the object itself.
  static std::size_t bytes(std::size_t dimension, std::size_t capacity) {
    return SampleStore::bytes(dimension, capacity) + capacity * sizeof(double);
  }

 private:
  SquaredExponential kernel_;
  SampleStore samples_;
  std::vector<double> beta_;
  double bias_ = 0.0;
};

}  // namespace kelpie
