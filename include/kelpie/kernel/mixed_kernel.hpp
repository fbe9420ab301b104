// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "kelpie/kernel/sample_store.hpp"
#include "kelpie/kernel/squared_exponential.hpp"

namespace kelpie {

/// κ(x, x') = s κ_SE(z, z') + λ φᵀφ': what the inputs z say by being alike, and what physics terms
/// φ say everywhere. A sample is z followed by φ, both scaled already; with no terms and s = 1 it
/// is the squared exponential.
class MixedKernel {
 public:
  /// Requires gamma > 0, s >= 0, lambda >= 0, and s > 0 where there are no terms.
  MixedKernel(double gamma, double s, double lambda, std::size_t inputs, std::size_t terms)
      : local_(gamma), s_(s), lambda_(lambda), inputs_(inputs), terms_(terms) {}

  /// The squared exponential by itself.
  MixedKernel(const SquaredExponential& local, std::size_t inputs)
      : MixedKernel(local.gamma(), 1.0, 0.0, inputs, 0) {}

  const SquaredExponential& local() const { return local_; }
  double s() const { return s_; }
  double lambda() const { return lambda_; }
  std::size_t inputs() const { return inputs_; }
  std::size_t terms() const { return terms_; }
  std::size_t dimension() const { return inputs_ + terms_; }

  /// The part of a sample that κ_SE, the density and the gate look at.
  std::span<const double> inputs_of(std::span<const double> x) const { return x.first(inputs_); }
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

 private:
  SquaredExponential local_;
  double s_;
  double lambda_;
  std::size_t inputs_;
  std::size_t terms_;
};

}  // namespace kelpie
