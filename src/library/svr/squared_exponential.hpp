// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "svr/sample_store.hpp"

namespace kelpie {

/// κ(x, x') = exp(−(x − x')ᵀ S⁻¹ (x − x')), S = Σ/γ (eq. 6). On scaled inputs z (InputScaling)
/// κ = exp(−γ |z − z'|²). κ(x, x) = 1.
///
/// One pass computes distances and exp by the widest instructions of the machine (Highway, chosen
/// at run time). The relative error is below (3 + |ln κ|) · 2^−52; κ below 2^−1021, where doubles
/// lose precision, is 0.
class SquaredExponential {
 public:
  explicit SquaredExponential(double gamma) : gamma_(gamma) {}  ///< Requires gamma > 0.

  double gamma() const { return gamma_; }

  /// out[i] = κ(z, sample first + i) for every element of `out`, by the first z.size() coordinates
  /// of the samples. Requires first + out.size() <= size().
  /// Cost O(d · out.size()). Allocates nothing.
  void row(std::span<const double> z, const SampleStore& samples, std::size_t first,
           std::span<double> out) const;

  /// The row of every sample; `out` needs room for samples.size() values.
  void row(std::span<const double> z, const SampleStore& samples, std::span<double> out) const {
    row(z, samples, 0, out.first(samples.size()));
  }

  /// Σ_i weights[i] κ(z, sample i), without a stored row. Requires a weight per sample. Cost and
  /// allocation as row().
  double expansion(std::span<const double> z, const SampleStore& samples,
                   std::span<const double> weights) const;

  /// Σ_i weights[i] (s κ + fine κ^32)(z, sample i) and its gradient by z, in one pass. Requires
  /// finite z, a weight per sample, and room for z.size() <= kMostDimensions values. Cost O(d n),
  /// about twice the cost of expansion(). Allocates nothing.
  double expansion_with_gradient(std::span<const double> z, const SampleStore& samples,
                                 std::span<const double> weights, double s, double fine,
                                 std::span<double> gradient) const;

  static constexpr std::size_t kMostDimensions = 64;

 private:
  double gamma_;
};

}  // namespace kelpie
