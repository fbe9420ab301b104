// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "kelpie/kernel/sample_store.hpp"

namespace kelpie {

/// κ(x, x') = exp(−(x − x')ᵀ S⁻¹ (x − x')), S = Σ/γ (eq. 6), on inputs that are scaled already
/// (InputScaling), so that κ = exp(−γ |z − z'|²). κ(x, x) = 1.
///
/// Distances and exp are computed in one pass by the widest instructions of the machine (Highway,
/// chosen at run time). The relative error is below (3 + |ln κ|) · 2^−52; where κ would be less
/// than 2^−1021, and doubles lose precision, it is 0.
class SquaredExponential {
 public:
  explicit SquaredExponential(double gamma) : gamma_(gamma) {}  ///< Requires gamma > 0.

  double gamma() const { return gamma_; }

  /// out[i] = κ(z, sample first + i), for all of `out`, by the first z.size() coordinates of the
  /// samples. Requires first + out.size() <= size().
  /// Cost O(d · out.size()). Allocates nothing.
  void row(std::span<const double> z, const SampleStore& samples, std::size_t first,
           std::span<double> out) const;

  /// The row against all samples; `out` needs room for samples.size() values.
  void row(std::span<const double> z, const SampleStore& samples, std::span<double> out) const {
    row(z, samples, 0, out.first(samples.size()));
  }

  /// Σ weights[i] κ(z, sample i) over all samples, without keeping the row. Requires a weight for
  /// every sample. Cost and allocation as for row().
  double expansion(std::span<const double> z, const SampleStore& samples,
                   std::span<const double> weights) const;

 private:
  double gamma_;
};

}  // namespace kelpie
