// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/roomy_vector.hpp"
#include "kelpie/core/archive.hpp"
#include "kelpie/core/matrix.hpp"
#include "posterior/triangle.hpp"
#include "svr/sample_store.hpp"
#include "svr/squared_exponential.hpp"

namespace kelpie {

/// The functions of a squared exponential at centres c_i, in the Newton basis (Müller & Schaback
/// 2009):
///
///     v(z) = L⁻¹ k(z),  k_i(z) = κ(z, c_i),  L Lᵀ = κ(c, c)
///
/// Function i is 0 at the centres before c_i, so that functions of earlier centres stay as they are
/// when a centre joins. 1 − |v(z)|² is the squared part of κ(z, ·) that no function holds: the
/// novelty of z. Inputs are in deviations. Allocates in the constructor only, but for move().
class KernelBasis {
 public:
  KernelBasis(double gamma, std::size_t inputs, std::size_t capacity);

  std::size_t size() const { return factor_.size(); }  ///< Number of centres.
  const SampleStore& centres() const { return centres_; }
  const SquaredExponential& kernel() const { return kernel_; }

  /// v(z) into `values`, of size() numbers; returns the novelty, 0 to 1. Cost O(n (n + inputs)).
  double evaluate(std::span<const double> z, std::span<double> values) const;

  /// Makes z a centre, by its values and novelty; the new function has the value √novelty at z.
  /// Requires room and novelty > 0.
  void add(std::span<const double> z, std::span<const double> values, double novelty);

  /// The weights of κ(z, c_i), of the function weights · v(z): L⁻ᵀ weights in their place.
  void to_kernel(std::span<double> weights) const { factor_.solve_upper(weights); }

  /// The kernel of inputs z ratio + shift from now on: centres move, and leave where they are no
  /// longer novel. Returns T: at the old centres the new functions are v' = Tᵀ v.
  Matrix move(std::span<const double> ratio, std::span<const double> shift, double least_novelty);

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  SquaredExponential kernel_;
  SampleStore centres_;
  Triangle factor_;  ///< L
};

}  // namespace kelpie
