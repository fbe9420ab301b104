// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "kelpie/core/archive.hpp"

namespace kelpie {

/// How many neighbouring rows make one independent sample (effective sample size: Bayley &
/// Hammersley 1946; Kass, Carlin, Gelman & Neal 1998), from the errors of a model in time order:
///
///     τ = (1 + ρ)/(1 − ρ),    ρ = ρ_l^(1/l)
///
/// with the autocorrelation ρ_l at the shortest of the lags 1, 2, 4 … 256 where ρ_l < 1/2: errors
/// are smooth from one sample to the next at a high rate, and the lag is in proportion to the rate.
/// ρ at lag 256 is the largest: τ is 739 at most. Allocates nothing.
class ErrorCorrelation {
 public:
  ErrorCorrelation();

  /// Adds the error of the next sample in time. Requires a finite value.
  void add(double error);

  double rows_per_sample() const { return rows_per_sample_; }  ///< τ

  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  static constexpr std::size_t kLags = 9;
  static constexpr std::size_t kLongest = std::size_t{1} << (kLags - 1);

  std::array<double, kLongest> errors_{};     ///< the last errors, in a ring
  std::array<double, kLags + 1> products_{};  ///< fading sums of e e' at lag 0, then at every lag
  std::int64_t count_ = 0;
  double rows_per_sample_;
};

}  // namespace kelpie
