// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "kelpie/core/archive.hpp"
#include "kelpie/core/matrix.hpp"

namespace kelpie {

/// Mean and covariance of a stream (Welford), in memory O(d²).
class Moments {
 public:
  static constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

  /// Up to `memory` samples have equal weights; later samples have the weight 1/memory on arrival,
  /// and earlier samples fade.
  explicit Moments(std::size_t dimension, std::size_t memory = kAll);

  void add(std::span<const double> x);  ///< Cost O(d²). Allocates nothing.

  std::size_t count() const { return count_; }  ///< Samples, at most `memory`.
  std::span<const double> mean() const { return mean_; }
  /// Sample covariance, divided by n − 1; 0 for n < 2. Allocates.
  Matrix covariance() const;
  double covariance(std::size_t i, std::size_t j) const;  ///< One value.

  std::size_t dimension() const { return mean_.size(); }
  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  std::size_t memory_;
  std::size_t count_ = 0;
  std::vector<double> mean_;
  std::vector<double> before_;  ///< deviation from the old mean
  Matrix scatter_;
};

/// The part of the inputs' covariance Σ in the kernel's S = Σ/γ.
enum class ScalingKind : std::uint8_t {
  full,      ///< all of Σ, as in the paper
  diagonal,  ///< the diagonal of Σ: inputs are not rotated
};

/// Largest number of inputs of a scaled sample, which is on the stack.
inline constexpr int kMostInputs = 64;

/// Largest number of physics terms of a model.
inline constexpr int kMostTerms = 128;

/// A sample for learners: scaled inputs, then scaled terms.
using ScaledSample = ShortVector<kMostInputs + kMostTerms>;

/// A scaled input z.
using ScaledInput = ShortVector<kMostInputs>;

/// The map z = W (x − mean) with |z − z'|² = (x − x')ᵀ Σ⁻¹ (x − x'), the Mahalanobis distance.
struct InputScaling {
  std::vector<double> mean;
  /// W, lower triangular; diagonal for ScalingKind::diagonal, with 0 for a constant input, which is
  /// left out.
  Matrix whitening;

  std::size_t dimension() const { return mean.size(); }

  /// Requires x of size dimension() <= kMostInputs. Allocates nothing.
  ScaledInput apply(std::span<const double> x) const;

  /// The inverse of apply(), with the mean for inputs left out. Requirements as there. Allocates
  /// nothing.
  ScaledInput invert(std::span<const double> z) const;

  /// The gradient by x from the gradient by z: Wᵀ ∂/∂z. Allocates nothing.
  ScaledInput pull_back(std::span<const double> gradient) const;

  /// The covariance Σ behind W; 0 for inputs left out.
  Matrix covariance() const;

  /// The scaling of these moments; empty when no input moves, or (ScalingKind::full) Σ is singular,
  /// see first_dependent().
  static std::optional<InputScaling> from(const Moments& moments, ScalingKind kind);

 private:
  bool take(const Moments& moments, ScalingKind kind);
  bool take_full(const Moments& moments);
};

/// The first input that is constant or (ScalingKind::full) a linear combination of earlier inputs,
/// to within 1e-10 of the variance; empty for an invertible covariance.
std::optional<std::size_t> first_dependent(const Moments& moments, ScalingKind kind);

/// The map y → (y − mean) / scale of one target.
struct TargetScaling {
  double mean = 0.0;
  double scale = 1.0;  ///< standard deviation, > 0

  double apply(double y) const { return (y - mean) / scale; }  ///< Standardised from raw.
  /// Raw from standardised.
  double invert(double standardised) const { return mean + scale * standardised; }
};

/// All maps of one axis.
struct AxisScaling {
  InputScaling input;
  TargetScaling target;
  std::vector<double> term_scale{};  ///< > 0: divisors of the physics terms

  /// core/archive.hpp; loads a scaling of `inputs` and `terms`.
  void visit(Archive& archive, std::size_t inputs, std::size_t terms);
};

}  // namespace kelpie
