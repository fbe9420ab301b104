// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kelpie/model/open_loop.hpp"
#include "kelpie/motion/term_set.hpp"
#include "kelpie/online/triangular_fit.hpp"

namespace kelpie {

/// What holds of one axis for long, in a form that is saved: the acceleration wᵀφ + w₀ of one
/// velocity, and what is known of its error.
struct SteadyModel {
  std::size_t state = 0;        ///< the input that is this axis' velocity
  std::vector<double> weights;  ///< w, then w₀, in the log's own units; empty: not known yet
  double error = 0.0;           ///< root mean square of the acceleration's error, one step ahead
  double error_time_s = 0.0;  ///< how long an error lasts, up to 10 s: autocorrelation e^(−t/this)
  double learned_error = 0.0;  ///< root mean square of the learned model's error, one step ahead
  double noise = 0.0;          ///< standard deviation of a measured velocity
  std::vector<Extremes> seen;  ///< every input's range

  bool ready() const { return !weights.empty(); }

  /// Requires ready() and the values of all terms at a sample.
  double acceleration(std::span<const double> phi) const;
};

/// The long memory of one axis: the equations of motion fitted to all samples since the start, or
/// since the vehicle changed, where a buffer keeps only some. Fitted to what the velocity did from
/// one sample to the next,
///
///     ν(t') − ν(t) = ∫ wᵀφ + w₀ dt ≈ (t' − t) (wᵀ (φ + φ')/2 + w₀),
///
/// which tells more of slow motion than accelerations do: those are filtered, and lag behind.
/// A step that took more than three times the usual, or over which the velocity jumped by what no
/// acceleration explains (the log was cut there), is left out.
///
/// Terms beyond TermSet::straight(), the products of command and velocity, are expected to make up
/// a tenth of the accelerations: w_k √(mean φ_k²) ~ N(0, (0.1 ẏ_rms)²), against errors as large and
/// as lasting as measured (ridge regression, Hoerl & Kennard 1970, by Bayes' rule). Where much is
/// unexplained they so need more evidence.
/// Allocates in the constructor only.
class SteadyPart {
 public:
  /// `state` is the input whose derivative the targets are.
  SteadyPart(TermSet terms, std::size_t inputs, std::size_t state);

  /// Learns from one valid sample: raw inputs, the acceleration and the time [s]. Cost O(m²) for
  /// m terms.
  void observe(std::span<const double> x, double y, double t);

  /// Takes note of what the learned model was off by before it saw a sample.
  void observe_learned(double error);

  /// The vehicle has changed: what was learned before counts as kBefore steps from now on, so it
  /// serves until the new steps outweigh it. Forgets everything where there is no model yet.
  void restart();

  void visit(Archive& archive);  ///< core/archive.hpp

  std::int64_t steps() const { return fit_.rows(); }

  /// Allocates. Not ready() before kLeastSteps steps and ten seconds more.
  SteadyModel model() const;

 private:
  bool known() const { return blocks_ > 0; }
  double error_time_s() const;
  double prior_of_products() const;
  void learn_step(double change, double y, double step_s);
  void learn_error(double error, double step_s);

  TermSet terms_;
  std::size_t state_;
  std::vector<Extremes> seen_;  ///< one per input
  TriangularFit fit_;
  std::vector<double> phi_;  ///< of the last sample, and a 1
  std::vector<double> next_;
  double velocity_ = 0.0;
  double target_ = 0.0;
  double time_s_ = 0.0;
  double usual_step_s_ = 0.0;
  double target_square_ = 0.0;   ///< mean of the targets' squares
  double error_square_ = 0.0;    ///< fading mean of the errors' squares
  double block_square_ = 0.0;    ///< the same of their means over ten seconds
  double block_sum_ = 0.0;       ///< of the block at hand: ∫ error dt,
  double block_s_ = 0.0;         ///< and its length
  double noise_square_ = 0.0;    ///< fading mean of what a step is off by that nothing explains
  double learned_square_ = 0.0;  ///< fading mean of the learned model's squared errors
  std::int64_t learned_ = 0;
  std::int64_t errors_ = 0;
  std::int64_t blocks_ = 0;
  std::int64_t samples_ = 0;
};

}  // namespace kelpie
