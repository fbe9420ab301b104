// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "svr/mixed_kernel.hpp"
#include "svr/sample_store.hpp"

namespace kelpie {

/// A trained regression function f(x) = Σ β_i κ(x_i, x) + b (eq. 5, with the bias), on scaled
/// samples, in units of the standardised target. The physics terms are summed into one weight per
/// term, w = λ Σ β_i φ_i for a support vector machine:
///
///     f(x) = Σ β_i (s κ_SE + fine κ_SE^32)(z_i, z) + wᵀφ + b,
///
/// with s = 1 but for models of version 0.1. Holds copies of the support vectors' inputs z_i.
/// Allocates in the constructor only.
class SvrFunction {
 public:
  /// Allocates for `capacity` support vectors.
  SvrFunction(const MixedKernel& kernel, std::size_t capacity);

  /// Copies the samples with a weight; inputs, and w from the terms. Cost O(n d).
  void assign(const SampleStore& samples, std::span<const double> beta, double bias);

  /// Copies the inputs of the centres with a weight, and w. Cost O(n inputs).
  void assign(const SampleStore& centres, std::span<const double> beta,
              std::span<const double> term_weights, double bias);

  /// Copies a function with the same kernel. Requires room for the support vectors. Cost
  /// O(n inputs). Allocates nothing.
  void assign(const SvrFunction& other);

  /// Adds a linear function of the terms: a weight per term, and the last number to the bias.
  void add(std::span<const double> weights);

  void clear();  ///< f(x) = 0

  /// Requires x of the kernel's dimension. Cost O(n inputs + terms). Allocates nothing; safe from
  /// many threads.
  double operator()(std::span<const double> x) const;

  /// f(x), equal to rounding, and its gradient by z and φ. Requires finite x, room for a value per
  /// dimension, and at most SquaredExponential::kMostDimensions inputs. Cost: one to two times
  /// operator(). Conditions as operator().
  double with_gradient(std::span<const double> x, std::span<double> gradient) const;

  const MixedKernel& kernel() const { return kernel_; }
  const SampleStore& support_vectors() const { return samples_; }  ///< z_i, without terms
  std::span<const double> beta() const { return {beta_.data(), samples_.size()}; }
  std::span<const double> term_weights() const { return term_weights_; }  ///< w
  double bias() const { return bias_; }

  void visit(Archive& archive);  ///< core/archive.hpp

  /// Memory of a function in bytes, beside the object itself.
  static std::size_t bytes(std::size_t inputs, std::size_t terms, std::size_t capacity) {
    return SampleStore::bytes(inputs, capacity) + (capacity + terms) * sizeof(double);
  }

 private:
  void take_over(const SampleStore& samples, std::span<const double> beta, double bias);

  MixedKernel kernel_;
  SampleStore samples_;
  std::vector<double> beta_;
  std::vector<double> term_weights_;
  double bias_ = 0.0;
};

}  // namespace kelpie
