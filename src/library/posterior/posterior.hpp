// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/roomy_vector.hpp"
#include "kelpie/core/archive.hpp"
#include "kelpie/core/matrix.hpp"
#include "kelpie/core/scaling.hpp"
#include "kelpie/svr/resources.hpp"
#include "learner/error_correlation.hpp"
#include "posterior/sample_sums.hpp"
#include "posterior/triangle.hpp"
#include "posterior/tuning.hpp"

namespace kelpie {

/// What a large error costs a sample.
enum class Likelihood : std::uint8_t {
  student,  ///< nearly all of its weight, as of an outlier
  huber,    ///< its influence stays bounded, as of a rare manoeuvre
  gauss,    ///< nothing
};

/// Features of one group have one prior width.
struct FeatureGroup {
  static constexpr std::size_t kMost = 16;      ///< Groups with a width.
  static constexpr std::uint8_t kKernel = 0;    ///< The kernel's functions.
  static constexpr std::uint8_t kFlat = kMost;  ///< The constant.
};

/// The Gaussian posterior of the weights θ of features φ of one axis, y = θᵀφ(x) + noise, in
/// information form (Bishop 2006, section 3.5; MacKay 1992):
///
///     A = Σ w φφᵀ,  b = Σ w y φ,   M θ = b/v,   M = A/v + diag(α_g D²),   v = σ² τ
///
/// A and b hold under any prior, so neither prior, noise nor scale has to be known beforehand:
/// - Scale: D_i² = A_ii/Σw is the mean square of a feature, and the targets enter the solve as
///   deviations from their mean, in standard deviations. The first feature is the constant 1.
/// - Widths of the prior by evidence: α_g ← (γ_g + h)/(|Dθ|_g² + h/α₀), γ_g = n_g − α_g tr Σ_gg,
///   for each group g of n_g features; h makes a hyperprior of the precision α₀.
/// - Independent samples: τ rows make one sample (ErrorCorrelation).
/// - Likelihood, by the error e of the prediction before learning and d² = σ² + s², with s² the
///   variance of the prediction by the first features, for where nothing is known a large error is
///   no outlier: Student's t with ν = 10, w = (ν + 1)/(ν + e²/d²) (Lange et al. 1989), Huber's
///   w = 3d/|e| beyond 3d (Huber 1981), or Gauss's w = 1.
///
/// A sample costs O(m²) for m features. solve() finds new weights in slices of bounded work: rows
/// of Cholesky's factor, then, at every tenth more of samples, columns of its inverse for the
/// widths. Slices leave the results unchanged. Units: of features and target, as given. Allocates
/// in the constructor only, but for change_features().
class Posterior {
 public:
  /// For at most `capacity` features, the first `first` of which are a model of their own, too.
  Posterior(std::size_t capacity, std::size_t first);

  void clear();  ///< Forgets all samples.

  /// Learns a sample; no more than ten while the target is a constant. `trust`: weight by the
  /// inputs, 0 to 1. A feature beyond those of the samples before counts as 0 there. Requires
  /// phi[0] = 1 and finite numbers. Cost O(m²).
  void add(std::span<const double> phi, double y, double trust, Likelihood likelihood);

  /// Learns the samples of sums by their first features, each with `share` of its weight. Cost
  /// O(n²) for n first features.
  void add(const SampleSums& others, double share);

  /// How a sample looks before learning; zeros without a model.
  struct Looks {
    double surprise = 0.0;    ///< e²/d², per the usual value where that is beyond 1
    double unknown = 0.0;     ///< s², in variances of the target
    double noise = 0.0;       ///< σ², likewise
    double deviations = 0.0;  ///< of the target from the mean
    double error = 0.0;       ///< standard error of Σ θ_i φ_i of the first features alone
  };
  /// `share`: of the sample in the usual e²/d², which is far from 1 where the terms do not hold.
  /// Cost O(m + n²) for n first features.
  Looks look(std::span<const double> phi, double y, double share = 0.0);

  bool wants_solve() const;  ///< A solve has not ended, or enough samples came since the last.

  /// Goes on with a solve for a slice of work, within the budget; true at the end of a solve.
  /// `group`: of each feature; FeatureGroup::kFlat for the constant.
  bool solve(std::span<const std::uint8_t> group, Budget& budget);

  /// Becomes the posterior of another's first features alone, of the same samples, without a model.
  /// Requires a capacity of as many features.
  void assign_first(const Posterior& other);

  /// Mean square of the difference of what this posterior and `other`, of the same features, say at
  /// the inputs of this posterior's samples, in variances σ² of the noise (Cook 1977). Requires
  /// models of both. Cost O(m²).
  double distance(const Posterior& other);

  bool ready() const { return !weights_.empty(); }  ///< A solve has ended.
  /// θ, target unit per unit of the feature, for deviations from centre(); of the features at the
  /// begin of the last solve.
  std::span<const double> weights() const { return {weights_.data(), weights_.size()}; }
  /// Of the first features without the others: the posterior of the leading block of M.
  std::span<const double> first_weights() const { return first_; }
  /// The mean of the targets at the last solve; before the first, so far.
  double centre() const { return ready() ? centre_ : seen_.targets().mean; }
  /// Standard error of a weight at the last step of the evidence; infinite before.
  double error(std::size_t feature) const;
  const SampleSums& sums() const { return seen_; }  ///< Of the samples so far.
  double rows_per_sample() const { return correlation_.rows_per_sample(); }  ///< τ
  double noise() const { return noise_ * spread_ * spread_; }  ///< σ², squared unit of the target.

  /// The samples become those of a vehicle with other weights: each target grows by stepᵀφ, and
  /// weights in service follow, those of the first features alone by `first`. From then on, samples
  /// so far weigh as `kept` independent ones, at most. A step of all weights stays in service for
  /// 100 rows. Cost O(m²).
  void tell_anew(std::span<const double> step, std::span<const double> first, double kept);

  /// The features from the number `first` on become others, φ' = Tᵀ φ, and the sums TᵀAT and Tᵀb.
  /// Weights follow as far as T allows, until the next solve. Allocates. Cost O(m³).
  void change_features(std::size_t first, const Matrix& t);

  void visit(Archive& archive);  ///< core/archive.hpp

  static std::size_t bytes(std::size_t capacity, std::size_t first);  ///< Memory in bytes.

 private:
  enum class Task : std::uint8_t { none, factorise, invert };

  void fade(double samples);
  bool differ() const;  ///< Whether targets differ, beyond rounding.
  double variance_of_first(std::span<const double> phi);
  double samples() const { return begun_.rows / begun_.rows_per_sample; }
  void begin_solve(std::span<const std::uint8_t> group);
  std::size_t step(std::span<const std::uint8_t> group);
  void find_weights(std::span<double> theta) const;
  void find_variance(std::size_t k);
  void update_widths(std::span<const std::uint8_t> group);
  double noise_beside(std::span<const double> theta, double informed);
  void serve();

  SampleSums seen_;
  ErrorCorrelation correlation_;

  // Prior and noise, in deviations of the target.
  std::vector<double> precision_;  ///< α_g
  double informed_ = 1.0;          ///< γ: the constant, and Σ γ_g
  double noise_ = 1.0;             ///< σ²
  double usual_ = 1.0;             ///< e²/d² of samples before learning
  double widths_at_ = 0.0;         ///< rows at the last step of the evidence

  /// A solve at hand, of the sums at its begin; features and target have the unit 1.
  struct Begun {
    double rows = 0.0, rows_per_sample = 1.0;
    double centre = 0.0, spread = 1.0;  ///< of the targets
    double square = 0.0;                ///< Σ w y²
  };
  Task task_ = Task::none;
  std::size_t next_ = 0;  ///< row or column
  int round_ = 0;         ///< of a young posterior, whose widths are far off
  Begun begun_;
  std::vector<double> told_;      ///< steps of tell_anew() since the begin
  Triangle sums_;                 ///< D⁻¹ A D⁻¹
  Triangle factor_;               ///< of M
  RoomyVector<double> scale_;     ///< D
  RoomyVector<double> right_;     ///< D⁻¹ b
  RoomyVector<double> theta_;     ///< D θ
  RoomyVector<double> variance_;  ///< of D θ
  RoomyVector<double> scratch_;

  // In service.
  RoomyVector<double> weights_, errors_;
  std::vector<double> first_;           ///< of the first features alone
  double first_noise_ = 1.0;            ///< σ² beside these, in deviations of the target
  Triangle first_factor_;               ///< of their M
  std::vector<double> first_scale_;     ///< their D
  double centre_ = 0.0, spread_ = 1.0;  ///< of the targets
  double served_at_ = 0.0;              ///< rows
};

/// centre() + θᵀφ; the mean of the targets before the first solve. Cost O(m).
double value(const Posterior& posterior, std::span<const double> phi);

/// The weights of functions become those of Posterior::change_features(), as far as T allows.
/// Allocates. Cost O(m³).
void change_functions(RoomyVector<double>& weights, std::size_t first, const Matrix& t);

/// Solves at once, without a budget. Cost O(m³).
void settle(Posterior& posterior, std::span<const std::uint8_t> group);

}  // namespace kelpie
