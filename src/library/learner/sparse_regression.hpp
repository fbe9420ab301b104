// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "learner/error_correlation.hpp"
#include "learner/triangular_fit.hpp"
#include "learner/tuning.hpp"
#include "svr/mixed_kernel.hpp"
#include "svr/robust_scale.hpp"
#include "svr/svr_function.hpp"

namespace kelpie {

/// Settings of a SparseRegression.
struct SparseRegressionSettings {
  std::size_t terms = 0;         ///< number of physics terms in use: the first terms
  std::size_t most_centres = 0;  ///< largest number of kernel centres; 0: linear
  double gamma = 0.2;            ///< γ of the kernel (eq. 6)
  double new_place = 0.1;        ///< fraction of a kernel function's squared norm for a new centre
  double ridge = 1.0;            ///< noise variance relative to the kernel part's
  double term_prior = 1.0;       ///< prior of a term without effect [samples]
  bool prior_by_noise = false;   ///< without kernels: less of this prior with little noise
};

/// Robust sparse kernel least squares over every sample since the start, without a buffer:
///
///     f(x) = Σ_j β_j κ_SE(c_j, z) + wᵀφ + b
///
/// with few centres c_j, on scaled samples. A sample becomes a centre if the present centres leave
/// more than `new_place` of the squared norm of its kernel function (approximate linear dependence:
/// Engel, Mannor & Meir 2004). The kernel part is fitted in the Newton basis of the centres,
/// v = L⁻¹κ with the centres' kernel matrix LLᵀ: the basis function of a new centre is 0 at the
/// earlier centres, and samples learned before stay valid. The prior is the |f|² of kernel ridge
/// regression in the Hilbert space.
///
/// With `prior_by_noise` the prior has the weight of σ²τ rows, at most `term_prior`: weights of
/// scaled terms vary by about 1, σ is the usual error, and τ rows count as an independent sample.
/// With little noise the samples of a first minute tell terms apart that go together. publish()
/// then costs O(m³): for few terms.
///
/// A sample with an error of e > 2.5 usual errors has the weight (2.5/e)², which makes the fit
/// robust to one-sided outliers as well. Allocates in the constructor only.
class SparseRegression {
 public:
  /// Samples are `inputs` scaled inputs followed by `terms` scaled physics terms. Requires
  /// settings.terms <= terms.
  SparseRegression(std::size_t inputs, std::size_t terms, const SparseRegressionSettings& settings);

  /// Learns from one sample of finite values. Cost O(m²) for m terms and centres.
  void update(std::span<const double> z, double y);

  /// update() without publish(), for several samples; publish() has to follow the last.
  /// `successive`: the sample follows the one before in time.
  void learn(std::span<const double> z, double y, bool successive = true);
  void publish();  ///< Updates model(). Cost O(m²), see above.

  /// The learned function, as of the last publish().
  const SvrFunction& model() const { return model_; }

  std::size_t centres() const { return centres_.size(); }

  /// Work of learn() and publish() [visited numbers].
  std::size_t work() const {
    const std::size_t m = first_centre() + centres();
    return 4 * m * m + (shrunk_ ? m * m * m / 3 : 0);
  }

  /// Standard error of a term's weight, in units of the standardised target per scaled term;
  /// infinite for an unused term. Rows with autocorrelated errors count as 1/τ (ErrorCorrelation).
  /// Cost O(m²).
  double term_error(std::size_t k) const;

  /// The vehicle has changed by a known step of the terms' weights: `step` has a number per term in
  /// use or more, the last is of the bias. Cost O(m²). Allocates nothing.
  void shift(std::span<const double> step);

  /// Limits what is known of the terms' weights to the weight of so many independent samples; the
  /// weights, and what is known of the kernel part, stay. Cost O(m²). Allocates nothing.
  void doubt_terms(double samples);

  /// Samples have another scale: term k becomes factors[k] φ_k, the target gain · y + offset. A
  /// linear regression forgets the usual error alone; kernels have other places in another scale,
  /// and a regression with kernels forgets as by clear(). Requires a positive factor per term,
  /// gain > 0. Cost O(m²). Allocates nothing.
  void rescale(std::span<const double> factors, double gain, double offset);

  /// Errors so far say nothing of the next: no sample is an outlier until the usual error is known.
  void forget_usual_error();

  void clear();  ///< Forgets everything but τ. Allocates nothing.

  /// Forgets the samples and keeps the estimate, with the weight of the prior: the start for a
  /// vehicle similar to the former vehicle. Allocates nothing.
  void weaken();

  /// Forgets everything but τ, and expects these weights of the terms, known as well as by so many
  /// samples: `weights` has a number per term in use or more, the last is of the bias. Allocates
  /// nothing.
  void expect(std::span<const double> weights, double samples);

  /// Forgets the samples since clear() or weaken() and keeps the usual error: a second round over
  /// the samples recognises outliers from its start. Allocates nothing.
  void start_over();

  /// Forgets everything and fits a function, as if from 2,000 samples at the places: whole samples,
  /// first the function's centres in order. Exact for a function of a SparseRegression with equal
  /// settings, else the closest fit. Allocates.
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
  double prior_samples() const;
  /// θ, as of the last publish().
  std::span<const double> theta() const { return shrunk_ ? shrunk_->theta() : fit_.theta(); }
  void set_coefficients(const SvrFunction& function);
  std::size_t first_centre() const { return settings_.terms + 1; }
  std::span<double> newton() { return {features_.data() + first_centre(), centres_.size()}; }
  std::span<const double> newton_row(std::size_t j) const {
    return {newton_.data() + j * settings_.most_centres, j + 1};
  }

  SparseRegressionSettings settings_;
  SampleStore centres_;
  std::vector<double> newton_;           ///< L, row-major
  TriangularFit fit_;                    ///< of φ, 1, v
  std::optional<TriangularFit> shrunk_;  ///< with `prior_by_noise`: fit_ with the prior
  std::vector<double> features_;         ///< φ, 1, v of the present sample
  std::vector<double> kappa_;            ///< scratch: a value per centre
  std::vector<double> beta_;             ///< a value per centre
  std::vector<double> term_weights_;
  std::vector<double> expected_;     ///< θ before the first sample
  std::vector<double> information_;  ///< of `expected_`: the prior
  RobustScale usual_error_{kOnline.members.error_least, kOnline.members.error_every};
  ErrorCorrelation correlation_;
  double known_rows_ = 0.0;  ///< rows behind the terms' weights
  std::int64_t samples_ = 0;
  SvrFunction model_;
};

}  // namespace kelpie
