// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kelpie/kernel/mixed_kernel.hpp"
#include "kelpie/online/robust_scale.hpp"
#include "kelpie/online/triangular_fit.hpp"
#include "kelpie/svr/svr_function.hpp"
#include "online/tuning.hpp"

namespace kelpie {

/// What a SparseRegression is told.
struct SparseRegressionSettings {
  std::size_t terms = 0;         ///< physics terms in use, the first ones
  std::size_t most_centres = 0;  ///< room for so many centres of the kernel; 0: a straight line
  double gamma = 0.2;            ///< γ of the kernel (eq. 6)
  double new_place = 0.1;        ///< share of a kernel function's squared norm that makes a centre
  double ridge = 1.0;            ///< variance of the noise against that of the kernel part
  double term_prior = 1.0;       ///< samples that say that a term has no effect
};

/// Robust least squares over all samples since the start, where a buffer keeps only the last ones:
///
///     f(x) = Σ_j β_j κ_SE(c_j, z) + wᵀφ + b
///
/// with few centres c_j, on scaled samples. A sample becomes a centre where the centres so far
/// can't tell its kernel function: where more than `new_place` of its squared norm is left (the
/// approximate linear dependence of Engel, Mannor & Meir 2004). The kernel part is fitted in the
/// Newton basis of the centres, v = L⁻¹κ with LLᵀ the centres' kernel matrix: the function of a new
/// centre is 0 at all those before, so that samples learned without it still count. Its prior is
/// that of kernel ridge regression, |f|² of the Hilbert space.
///
/// A sample off by more than 2.5 usual errors counts the less the farther it is off, (2.5/e)² times
/// where it is off by e of them, so that even one-sided outliers draw it nowhere. Allocates in the
/// constructor only.
class SparseRegression {
 public:
  /// Samples are `inputs` scaled inputs followed by `terms` scaled physics terms. Requires
  /// settings.terms <= terms.
  SparseRegression(std::size_t inputs, std::size_t terms, const SparseRegressionSettings& settings);

  /// Learns from one sample, all finite. Cost O(m²) for m terms and centres.
  void update(std::span<const double> z, double y);

  /// The same of one of several samples, after the last of which publish() is to be called.
  void learn(std::span<const double> z, double y);
  void publish();  ///< Brings model() up to date. Cost O(m²).

  /// What it has learned, as any other model says it. Cost O(m²), once after an update.
  const SvrFunction& model() const { return model_; }

  std::int64_t samples() const { return samples_; }  ///< learned so far
  std::size_t centres() const { return centres_.size(); }

  /// Numbers that learn() and publish() look at.
  std::size_t work() const {
    const std::size_t m = first_centre() + centres();
    return 4 * m * m;
  }

  /// Standard error of the weight of a term, in units of the standardised target per scaled term;
  /// infinite for a term not in use. Cost O(m²).
  double term_error(std::size_t k) const;

  void clear();  ///< Forgets everything. Allocates nothing.

  /// Forgets all samples, but not what they said: it says so still, as weakly as its prior, until
  /// others say otherwise. For another vehicle that is much like the one before. Allocates nothing.
  void weaken();

  /// Forgets the samples since clear() or weaken(), but not how large errors usually are: who shows
  /// them once more has outliers told from the first one on. Allocates nothing.
  void start_over();

  /// Forgets everything and says what a function says, as if it had learned it from 2,000 samples
  /// at these places: whole samples, first the function's centres in their order. The same function
  /// where it comes from another SparseRegression with such settings; else as near as it gets.
  /// Allocates.
  void imitate(const SvrFunction& function, const SampleStore& places);

  void visit(Archive& archive);  ///< core/archive.hpp

  /// Memory in bytes, beside the object itself.
  static std::size_t bytes(std::size_t inputs, std::size_t terms,
                           const SparseRegressionSettings& settings);

 private:
  void compute_features(std::span<const double> z, double new_place);
  void add_centre(std::span<const double> z, double left);
  void forget_samples();
  double weight_of(double error) const;
  void set_coefficients(const SvrFunction& function);
  std::size_t first_centre() const { return settings_.terms + 1; }
  std::span<double> newton() { return {features_.data() + first_centre(), centres_.size()}; }
  std::span<const double> newton_row(std::size_t j) const {
    return {newton_.data() + j * settings_.most_centres, j + 1};
  }

  SparseRegressionSettings settings_;
  SampleStore centres_;
  std::vector<double> newton_;    ///< L, row-major
  TriangularFit fit_;             ///< of φ, 1, v
  std::vector<double> features_;  ///< φ, 1, v of the sample at hand
  std::vector<double> kappa_;     ///< scratch: a value per centre
  std::vector<double> beta_;      ///< a value per centre
  std::vector<double> term_weights_;
  std::vector<double> expected_;     ///< θ before the first sample
  std::vector<double> information_;  ///< its: the prior
  RobustScale usual_error_{kOnline.members.error_least, kOnline.members.error_every};
  std::int64_t samples_ = 0;
  SvrFunction model_;
};

}  // namespace kelpie
