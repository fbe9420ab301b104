// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "kelpie/kernel/sample_store.hpp"
#include "kelpie/kernel/squared_exponential.hpp"

namespace kelpie {

/// What a MixedKernel is made of.
struct KernelWeights {
  double s = 1.0;       ///< of κ_SE; other than 1 only in models of older files
  double fine = 0.0;    ///< of κ_SE^32
  double lambda = 0.0;  ///< λ, of the physics terms
};

/// κ(x, x') = s κ_SE(z, z') + fine κ_SE(z, z')^32 + λ φᵀφ': what the inputs z say by being alike,
/// by being nearly the same (a squared exponential of 32 γ, which lets the model follow what only
/// holds for a short while, such as the wake of its own manoeuvre, without believing it far from
/// there), and what physics terms φ say everywhere. A sample is z followed by φ, both scaled
/// already; with the default weights it is the squared exponential.
class MixedKernel {
 public:
  /// Requires gamma > 0, no negative weight, and s > 0 where there are no terms.
  MixedKernel(double gamma, const KernelWeights& weights, std::size_t inputs, std::size_t terms)
      : local_(gamma),
        fine_(kFineRatio * gamma),
        weights_(weights),
        inputs_(inputs),
        terms_(terms) {}

  /// The squared exponential by itself.
  MixedKernel(const SquaredExponential& local, std::size_t inputs)
      : MixedKernel(local.gamma(), {}, inputs, 0) {}

  const SquaredExponential& local() const { return local_; }
  const KernelWeights& weights() const { return weights_; }
  std::size_t inputs() const { return inputs_; }
  std::size_t terms() const { return terms_; }
  std::size_t dimension() const { return inputs_ + terms_; }

  /// The part of a sample that κ_SE, the density and the gate look at.
  std::span<const double> inputs_of(std::span<const double> x) const { return x.first(inputs_); }
  /// The physics terms of a sample.
  std::span<const double> terms_of(std::span<const double> x) const { return x.subspan(inputs_); }

  /// κ_SE against all samples. Requires room for samples.size() values. Cost O(n inputs).
  void similarity(std::span<const double> x, const SampleStore& samples,
                  std::span<double> out) const {
    local_.row(inputs_of(x), samples, out);
  }

  /// κ against all samples, from their similarity. Cost O(n terms).
  void row(std::span<const double> x, const SampleStore& samples,
           std::span<const double> similarity, std::span<double> out) const;

  /// κ(x, x).
  double self(std::span<const double> x) const;

  /// Σ beta[i] s κ_SE(x, sample i) and Σ beta[i] fine κ_SE(x, sample i)^32: two parts of an
  /// expansion, the third being that of the terms. Cost O(n inputs), none without a fine part.
  double expansion(std::span<const double> x, const SampleStore& samples,
                   std::span<const double> beta) const;
  /// The fine part of Σ_i β_i κ(x_i, x), its weight included.
  double fine_expansion(std::span<const double> x, const SampleStore& samples,
                        std::span<const double> beta) const;

  /// Both parts together, with the gradient by the inputs: SquaredExponential's.
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
