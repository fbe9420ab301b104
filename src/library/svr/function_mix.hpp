// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "kelpie/core/scaling.hpp"
#include "svr/svr_function.hpp"

namespace kelpie {

/// What holds predictions back, in units of the standardised target.
struct Limits {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  double caution = 0.0;  ///< κ >= 0: weight of the functions' disagreement
};

/// A range of values of a target or physics term, in the learner's scale.
struct ValueRange {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

/// The sample with every physics term moved into its range: functions are linear in the terms, and
/// beyond the samples a line through squares and products is a guess. Terms are the last
/// ranges.size() numbers of x. Requires x.size() <= kMostInputs + kMostTerms. Allocates nothing.
ScaledSample within_ranges(std::span<const ValueRange> ranges, std::span<const double> x);

/// A weighted mean of functions, each clamped to the limits, on scaled samples with the terms
/// within their ranges, beside the physics terms of a vehicle known beforehand: the functions then
/// say what that vehicle leaves.
///
///     f = Σ s_k f_k,  f_k = clamp(f_k(within_ranges(x)), low, high)
///
/// Where the functions disagree, the mean is shrunk towards the last function, the simplest. With
/// the variance D² of all functions but the last, weighted by their shares, and g = f − f_last:
///
///     value = f − g κD² / (g² + 1 + κD²)
///
/// The disagreement of models of the same data estimates the variance of a prediction (ensembles:
/// Krogh & Vedelsby 1995), and a mean with this variance is shrunk as by James & Stein (1961).
/// Shares have the sum 1. Holds copies of the functions. Predictions cost the sum over the
/// functions, allocate nothing, and are safe from many threads.
struct FunctionMix {
  /// A function with name and weight.
  struct Member {
    std::string name;  ///< of a mixture's member
    double share = 1.0;
    SvrFunction function;
  };

  std::vector<Member> members;
  Limits limits{};
  std::vector<ValueRange> term_ranges{};  ///< one per physics term; empty: unlimited
  std::vector<double> nominal{};  ///< weights of the vehicle known, one per term; empty: none

  double operator()(std::span<const double> x) const;  ///< The value, and the vehicle known.
  /// The value, equal to rounding, and its gradient by z and φ; beyond the limits a function has
  /// the slope 0, as has the mean by a term beyond the term's range. Requires finite x and room for
  /// x.size() <= kMostInputs + kMostTerms values.
  double with_gradient(std::span<const double> x, std::span<double> gradient) const;

  /// The range of a physics term.
  ValueRange term_range(std::size_t k) const {
    return term_ranges.empty() ? ValueRange{} : term_ranges[k];
  }

  /// The weight of a physics term of the vehicle known.
  double nominal_weight(std::size_t k) const { return nominal.empty() ? 0.0 : nominal[k]; }

  /// The weight of a physics term inside limits and range, with the vehicle known: of the member
  /// `posterior` where there is one, else Σ share_k w_k.
  double term_weight(std::size_t k) const;
};

}  // namespace kelpie
