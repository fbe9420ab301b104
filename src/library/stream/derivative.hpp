// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kelpie/stream/signal_history.hpp"
#include "kelpie/stream/stream_plan.hpp"

namespace kelpie {

/// Weights w with Σᵢ wᵢ v(tᵢ) = slope at t of the polynomial fitted to the v(tᵢ); `offsets_s` are
/// the tᵢ − t. Unit 1/s. Exact for polynomials up to `degree`. Requires more than `degree`
/// different offsets. By orthogonal polynomials (Forsythe, J. SIAM 5, 1957): O(n degree).
class SlopeWeights {
 public:
  explicit SlopeWeights(std::size_t most);  ///< For up to `most` offsets. Allocates.

  /// The weights, valid until the next call. Allocates nothing.
  std::span<const double> at(std::span<const double> offsets_s, int degree);

 private:
  std::vector<double> weights_;
  std::vector<double> polynomial_;  // at the offsets, of one degree …
  std::vector<double> before_;      // … and of the degree below
};

/// Computes derivatives of signals by the filter of DerivativeSettings.
class Derivative {
 public:
  /// For signals with up to `most` samples and gaps of `gap_s`. Requires valid settings. Allocates.
  Derivative(const DerivativeSettings& settings, double gap_s, std::size_t most);

  /// The derivative at t. NaN if the window extends beyond the first or last sample, or into a gap,
  /// by more than the mean step (causal: two steps), or has too few samples. Allocates nothing.
  double at(const SignalHistory& signal, double t);

 private:
  bool reaches_back(const SignalHistory& signal, std::size_t first, double edge, double step) const;
  bool reaches_ahead(const SignalHistory& signal, std::size_t end, double edge, double step) const;

  DerivativeSettings settings_;
  double gap_s_;
  std::vector<double> offsets_s_;
  SlopeWeights weights_;
};

}  // namespace kelpie
