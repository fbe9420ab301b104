// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "svr/sample_store.hpp"
#include "svr/squared_exponential.hpp"

namespace kelpie {

/// The weights of the parts of a MixedKernel.
struct KernelWeights {
  double s = 1.0;       ///< of κ_SE; 1 but for models of version 0.1
  double fine = 0.0;    ///< of κ_SE^32
  double lambda = 0.0;  ///< λ, of the physics terms
};

/// κ(x, x') = s κ_SE(z, z') + fine κ_SE(z, z')^32 + λ φᵀφ', a sum of three parts: similar inputs z;
/// nearly equal inputs (the short-range part, a squared exponential of 32 γ, which follows
/// short-lived effects such as the wake of a manoeuvre without an effect elsewhere); and physics
/// terms φ, valid everywhere. A sample consists of z and φ, both scaled. With the default weights
/// κ is the squared exponential.
class MixedKernel {
 public:
  /// Requires gamma > 0, no negative weight, and s > 0 without terms.
  MixedKernel(double gamma, const KernelWeights& weights, std::size_t inputs, std::size_t terms)
      : local_(gamma),
        fine_(kFineRatio * gamma),
        weights_(weights),
        inputs_(inputs),
        terms_(terms) {}

  /// The squared exponential without other parts.
  MixedKernel(const SquaredExponential& local, std::size_t inputs)
      : MixedKernel(local.gamma(), {}, inputs, 0) {}

  const SquaredExponential& local() const { return local_; }
  const KernelWeights& weights() const { return weights_; }
  std::size_t inputs() const { return inputs_; }
  std::size_t terms() const { return terms_; }
  std::size_t dimension() const { return inputs_ + terms_; }

  /// The inputs z of a sample, used by κ_SE, density and gate.
  std::span<const double> inputs_of(std::span<const double> x) const { return x.first(inputs_); }
  /// The physics terms of a sample.
  std::span<const double> terms_of(std::span<const double> x) const { return x.subspan(inputs_); }

  /// κ_SE between x and every sample. Requires room for samples.size() values. Cost O(n inputs).
  void similarity(std::span<const double> x, const SampleStore& samples,
                  std::span<double> out) const {
    local_.row(inputs_of(x), samples, out);
  }

  /// κ between x and every sample, from the similarity. Cost O(n terms).
  void row(std::span<const double> x, const SampleStore& samples,
           std::span<const double> similarity, std::span<double> out) const;

  /// κ(x, x).
  double self(std::span<const double> x) const;

  /// Σ_i β_i s κ_SE(x_i, x). Cost O(n inputs).
  double expansion(std::span<const double> x, const SampleStore& samples,
                   std::span<const double> beta) const;
  /// Σ_i β_i fine κ_SE(x_i, x)^32, the short-range part. Cost O(n inputs); none with fine = 0.
  double fine_expansion(std::span<const double> x, const SampleStore& samples,
                        std::span<const double> beta) const;

  /// The sum of both parts and its gradient by the inputs
  /// (SquaredExponential::expansion_with_gradient).
  double expansion_with_gradient(std::span<const double> x, const SampleStore& samples,
                                 std::span<const double> beta, std::span<double> gradient) const {
    return local_.expansion_with_gradient(inputs_of(x), samples, beta, weights_.s, weights_.fine,
                                          gradient);
  }

 private:
  static constexpr double kFineRatio = 32.0;

  SquaredExponential local_;
  SquaredExponential fine_;
  KernelWeights weights_;
  std::size_t inputs_;
  std::size_t terms_;
};

}  // namespace kelpie
