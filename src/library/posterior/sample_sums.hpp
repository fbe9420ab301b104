// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/roomy_vector.hpp"
#include "kelpie/core/archive.hpp"
#include "kelpie/core/scaling.hpp"
#include "posterior/triangle.hpp"

namespace kelpie {

/// What a Posterior knows of samples, whatever the prior, the noise and the unit: sums of features
/// φ and targets y with weights w. φ[0] = 1. Units: of features and target. Allocates in the
/// constructor only.
struct SampleSums {
  explicit SampleSums(std::size_t capacity) : gram(capacity) { moment.reserve(capacity); }

  double origin = 0.0;         ///< the first target: y is the difference from the origin
  Triangle gram;               ///< A = Σ w φφᵀ
  RoomyVector<double> moment;  ///< b = Σ w y φ
  double rows = 0.0;
  double weight = 0.0;  ///< Σ w
  double square = 0.0;  ///< Σ w y²

  void clear();
  /// A feature beyond those of the samples before counts as 0 there. Cost O(m²).
  void add(std::span<const double> phi, double y, double w);
  /// The samples of other sums, by their first features, each with `share` of its weight: features
  /// beyond count as 0 there. Cost O(features²).
  void add(const SampleSums& other, std::size_t features, double share);
  void scale(double share);  ///< Each weight, and the number of rows.

  /// Each target grows by stepᵀφ, with a step of the first features. Cost O(m²).
  void tell_anew(std::span<const double> step);

  /// Mean and standard deviation of the targets; 0 and 1 without samples.
  TargetScaling targets() const;
  double root_mean_square(std::size_t feature) const;

  void visit(Archive& archive);  ///< core/archive.hpp

  /// origin, rows, weight, square, b, and A, row i of which has the columns 0 to i. Allocates.
  std::vector<double> numbers() const;
  static std::size_t count_numbers(std::size_t features) {
    return 4 + features + features * (features + 1) / 2;
  }
  /// Of numbers(). Requires count_numbers() of them, and room for the features.
  void assign(std::size_t features, std::span<const double> numbers);

  static std::size_t bytes(std::size_t capacity) {  ///< Memory in bytes.
    return (capacity * (capacity + 1) / 2 + capacity) * sizeof(double);
  }

 private:
  template <typename Use>
  void each(Use use);
};

}  // namespace kelpie
