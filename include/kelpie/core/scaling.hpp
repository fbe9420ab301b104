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

/// Mean and covariance of a stream, one sample at a time (Welford), in memory O(d²).
class Moments {
 public:
  static constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

  /// Of so many values, none seen yet. All samples weigh alike up to `memory` of them; from then on
  /// each weighs 1/memory when it comes, and those before fade.
  explicit Moments(std::size_t dimension, std::size_t memory = kAll);

  void add(std::span<const double> x);  ///< Cost O(d²). Allocates nothing.

  /// As if `count` samples of this mean and covariance had been seen. Requires 2 <= count <=
  /// memory.
  void assume(std::span<const double> mean, const Matrix& covariance, std::size_t count);

  std::size_t count() const { return count_; }  ///< samples that count, at most `memory`
  std::span<const double> mean() const { return mean_; }
  /// Of the sample, divided by n − 1; 0 for n < 2. Allocates.
  Matrix covariance() const;
  double covariance(std::size_t i, std::size_t j) const;  ///< One of its values.

  std::size_t dimension() const { return mean_.size(); }
  void visit(Archive& archive);  ///< core/archive.hpp

 private:
  std::size_t memory_;
  std::size_t count_ = 0;
  std::vector<double> mean_;
  std::vector<double> before_;  ///< deviation from the old mean
  Matrix scatter_;
};

/// Which part of the inputs' covariance Σ the kernel's S = Σ/γ uses.
enum class ScalingKind : std::uint8_t {
  full,      ///< all of Σ, as the paper says
  diagonal,  ///< its diagonal: correlated inputs are not rotated into each other
};

/// The most inputs a scaled sample can have: it lives on the stack.
inline constexpr int kMostInputs = 64;

/// The most physics terms a model can have besides.
inline constexpr int kMostTerms = 128;

/// A sample as learners take it: the scaled inputs, then the scaled terms.
using ScaledSample = ShortVector<kMostInputs + kMostTerms>;

/// A scaled input z.
using ScaledInput = ShortVector<kMostInputs>;

/// The map z = W (x − mean) with |z − z'|² = (x − x')ᵀ Σ⁻¹ (x − x'), the Mahalanobis distance.
struct InputScaling {
  std::vector<double> mean;
  /// W, lower triangular; diagonal for ScalingKind::diagonal, where an input that has never moved
  /// has a 0: it is left out.
  Matrix whitening;

  std::size_t dimension() const { return mean.size(); }

  /// Requires x of size dimension() <= kMostInputs. Allocates nothing.
  ScaledInput apply(std::span<const double> x) const;

  /// The x that apply() makes this z of, the mean for inputs left out. Requirements as there.
  /// Allocates nothing.
  ScaledInput invert(std::span<const double> z) const;

  /// The gradient by x of what has this gradient by z: Wᵀ ∂/∂z. Allocates nothing.
  ScaledInput pull_back(std::span<const double> gradient) const;

  /// The covariance Σ that W was made of; 0 for inputs left out.
  Matrix covariance() const;

  /// The largest standard deviation that these moments give a scaled input, which was 1; infinite
  /// where an input that was left out has moved.
  double growth(const Moments& moments) const;

  /// Becomes the scaling of these moments. False when no input moves, or (ScalingKind::full) Σ is
  /// singular, see first_dependent(); then nothing holds of the scaling. Allocates nothing where it
  /// was one of as many inputs, but for ScalingKind::full.
  bool take(const Moments& moments, ScalingKind kind);

  /// A new one; nothing where take() is false.
  static std::optional<InputScaling> from(const Moments& moments, ScalingKind kind);

 private:
  bool take_full(const Moments& moments);
};

/// The first input that is constant or (ScalingKind::full) a linear combination of those before it,
/// to within 1e-10 of its variance; nothing when the covariance can be inverted.
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
  std::vector<double> term_scale{};  ///< > 0: what each physics term is divided by

  /// core/archive.hpp; what is loaded is of so many inputs and terms.
  void visit(Archive& archive, std::size_t inputs, std::size_t terms);
};

}  // namespace kelpie
